// The page that `nsma report` writes, opened in a browser: what it shows is what was computed, and it asks for nothing.
#include "report/page/report_page.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "../support/browser.hpp"
#include "sample.hpp"
#include "study/sweep/sweep_queue.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/study_records.hpp"

namespace {

using namespace nsma;
using nlohmann::json;

std::string scene_text(const std::string& title, const std::string& bar, const std::string& patterns) {
    return "title = " + json(title).dump() + "\n[bar]\n" + bar + "[mesh]\ncells = 20\n[patterns]\n" + patterns +
           "\n[levels]\nlist = [1.1, 4.5, 6.0, 12.6]\n[program]\nobjective = \"least-shock\"\n";
}
constexpr const char* unit_bar = "length = 1.0\nyoung_modulus = 1.0\ndensity = 1.0\narea = 1.0\ngap = 1.0\n";
constexpr const char* steel_bar = "length = 0.8\nyoung_modulus = 210e9\ndensity = 7850.0\narea = 1e-4\ngap = 2e-4\n";

class ReportPage : public sample::Folder {
protected:
    void SetUp() override {
        sample::Folder::SetUp();
        if (!browser::program()) GTEST_SKIP() << "no browser here";
    }

    /// Solves the scene, stores what came of it and opens its page.
    browser::Page& open(const std::string& text, const std::string& fragment = "") {
        scene = parse_scene(text, "test");
        SweepQueue queue(scene, {}, SweepQueue::Order::scene);
        SweepWorker worker(scene, {});
        results.clear();
        while (!queue.finished()) {
            for (const WorkResult& result : worker.run(queue.next(0))) {
                queue.done(result);
                results.push_back(result);
            }
        }
        sample::store(path / "sweep", scene, results);
        return open_page(path / "sweep", fragment);
    }
    browser::Page& open_page(const std::filesystem::path& folder, const std::string& fragment = "") {
        file = folder / report_name;
        sample::write(file, report_page(folder, "nsma test"));
        page.emplace();
        page->size(1280, 800);
        page->open("file://" + file.string() + fragment);
        return *page;
    }

    void TearDown() override {
        if (page) {
            EXPECT_THAT(page->errors(), testing::IsEmpty());
            EXPECT_THAT(page->requests(), testing::IsEmpty());
        }
        sample::Folder::TearDown();
    }

    [[nodiscard]] const OrbitAnswer& answer(int free, int contact, std::optional<double> level) const {
        for (const WorkResult& result : results) {
            const auto& found = result.answer;
            if (found && found->orbit && found->pattern.free_steps == free && found->pattern.contact_steps == contact &&
                found->level == level)
                return *found;
        }
        throw std::runtime_error("no such answer");
    }

    /// The pattern and level that the page shows, as in its address.
    [[nodiscard]] std::string shown() { return page->evaluate("location.hash"); }

    /// All that the page computes of the orbit it shows, against the program.
    void expect_motion(const OrbitAnswer& expected) {
        const Orbit& orbit = *expected.orbit;
        const auto values = [&](const char* expression) {
            const auto list = page->evaluate(expression).get<std::vector<double>>();
            return Eigen::VectorXd(
                Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
        };
        const auto expect_near = [](const Eigen::VectorXd& got, const Eigen::VectorXd& want) {
            ASSERT_EQ(got.size(), want.size());
            // Sums of at most some hundred terms in another order.
            EXPECT_LT((got - want).cwiseAbs().maxCoeff(), 1e-12 * want.cwiseAbs().maxCoeff());
        };
        expect_near(values("[...nsma.sweep.motion.tip]"), tip_displacement(orbit));
        expect_near(values("[...nsma.sweep.motion.force]"), contact_force(orbit));
        // Stress and velocity in the middle of a cell, and the displacement that the strain adds up to, at some steps.
        const Field want = field(orbit);
        const int period = orbit.kernel.pattern.period_steps();
        const int cells = orbit.kernel.pattern.cells;
        for (const int n : {0, 1, period / 4, period / 2, period - 1}) {
            const std::string over = "Array.from({length: " + std::to_string(cells) + "}, (_, i) => nsma.sweep.motion.";
            const std::string at = ", " + std::to_string(n);
            expect_near(values((over + "stress(i + 0.5" + at + "))").c_str()), want.stress.col(n));
            expect_near(values((over + "velocity(i + 0.5" + at + "))").c_str()), want.velocity.col(n));
            Eigen::VectorXd displacement = want.stress.col(n) * (orbit.bar.length / cells / orbit.bar.young_modulus);
            for (int i = 1; i < cells; ++i) displacement[i] += displacement[i - 1];
            expect_near(values((over + "displacement(i + 1" + at + "))").c_str()), displacement);
        }
    }

    Scene scene;
    std::vector<WorkResult> results;
    std::filesystem::path file;
    std::optional<browser::Page> page;
};

TEST_F(ReportPage, ShowsTheMotionThatWasComputed) {
    for (const char* bar : {unit_bar, steel_bar}) {
        open(scene_text("First mode", bar, "mode = 1"), "#r=60&p=10&E=12.6");
        expect_motion(answer(60, 10, 12.6));
        // Another fragment is another orbit; what is not there is said.
        page->evaluate("location.hash = '#r=48&p=16'");
        page->wait_until("nsma.sweep.orbit.level === null");
        expect_motion(answer(48, 16, std::nullopt));
        page->evaluate("location.hash = '#r=48&p=16&E=7'");
        page->wait_until("document.querySelector('#message').textContent !== ''");
        EXPECT_EQ(page->evaluate("document.querySelector('#message').textContent"),
                  "No orbit of (r = 48, p = 16) at 7 is in this report.");
        // So it is where the page opens with it; the address stays, another orbit is shown.
        page->open("about:blank");
        page->open("file://" + file.string() + "#r=48&p=16&E=7");
        EXPECT_EQ(page->evaluate("document.querySelector('#message').textContent"),
                  "No orbit of (r = 48, p = 16) at 7 is in this report.");
        EXPECT_EQ(shown(), "#r=48&p=16&E=7");
        // In joules as well.
        const double joules = 6.0 * scene.bar.energy_unit();
        page->evaluate("location.hash = '#r=60&p=10&E=" + json(joules).dump() + "J'");
        page->wait_until("nsma.sweep.orbit.level === 6");
        EXPECT_THAT(page->errors(), testing::IsEmpty());
        page.reset();
        std::filesystem::remove_all(path / "sweep");
    }
}

TEST_F(ReportPage, AClickOnAMarkShowsItsOrbit) {
    open(scene_text("First mode", unit_bar, "mode = 1"), "#r=48&p=16");
    const json place = page->evaluate(
        "(() => { const {diagram, report} = nsma.sweep;"
        " const orbit = report.orbits.find(({pattern, level}) => pattern.free === 60 && level === 6);"
        " const point = diagram.pointOf(orbit), box = diagram.plot.svg.getBoundingClientRect();"
        " return [box.left + diagram.plot.x(point.x), box.top + diagram.plot.y(point.y)]; })()");
    page->hover(place[0], place[1]);
    EXPECT_THAT(page->evaluate("document.querySelector('.hint').textContent").get<std::string>(),
                testing::HasSubstr("(r = 60, p = 10)"));
    page->click(place[0].get<double>(), place[1].get<double>());
    EXPECT_EQ(shown(), "#r=60&p=10&E=6");
    expect_motion(answer(60, 10, 6.0));
    // Along the branch and back, and to the next frequency.
    page->evaluate("document.querySelector('#diagram svg').focus()");
    page->key("ArrowRight");
    EXPECT_EQ(shown(), "#r=60&p=10&E=12.6");
    page->key("ArrowLeft");
    page->key("ArrowLeft");
    EXPECT_EQ(shown(), "#r=60&p=10&E=4.5");
    page->key("ArrowUp");
    EXPECT_THAT(shown(), testing::StartsWith("#r=58&p=11"));
}

TEST_F(ReportPage, LayersAndUnitsOfTheDiagramAreChosen) {
    open(scene_text("First mode", unit_bar, "mode = 1"));
    const auto layers = [&] { return page->evaluate("document.querySelectorAll('#diagram path.solved').length"); };
    EXPECT_EQ(layers(), 1);
    page->evaluate(
        "[...document.querySelectorAll('#legend label')].find((one) => one.textContent.includes('proved the "
        "best')).querySelector('input').click()");
    EXPECT_EQ(layers(), 0);
    const auto label = [&] {
        return page->evaluate("document.querySelector('#diagram').textContent").get<std::string>();
    };
    EXPECT_THAT(label(), testing::HasSubstr("energy E/E_g"));
    page->click("#joules");
    page->click("#hertz");
    EXPECT_THAT(label(), testing::AllOf(testing::HasSubstr("energy E (J)"), testing::HasSubstr("frequency (Hz)")));
    const json before = page->evaluate("nsma.sweep.diagram.plot.view");
    page->click("#zoom-in");
    EXPECT_NE(page->evaluate("nsma.sweep.diagram.plot.view"), before);
    page->click("#zoom-reset");
    EXPECT_EQ(page->evaluate("nsma.sweep.diagram.plot.view"), before);
    // Never farther out than the whole, nor nearer than can be told.
    page->evaluate("for (let i = 0; i < 200; ++i) nsma.sweep.diagram.plot.zoom(1.25)");
    EXPECT_EQ(page->evaluate("nsma.sweep.diagram.plot.view"), before);
    page->evaluate("for (let i = 0; i < 500; ++i) nsma.sweep.diagram.plot.zoom(0.7)");
    EXPECT_EQ(page->evaluate("nsma.sweep.diagram.plot.view.x[0] < nsma.sweep.diagram.plot.view.x[1]"), true);
}

// Patterns of one period share a frequency: orbits lie upon each other.
TEST_F(ReportPage, EveryOrbitIsReachedByKeysAndClicks) {
    open(scene_text("Many", unit_bar, "period = [3.4, 3.6]"));
    const json reached = page->evaluate(
        "(() => { const {sweep} = nsma, seen = new Set(), open = [sweep.orbit];"
        " while (open.length > 0) { const orbit = open.pop(); if (seen.has(orbit)) continue; seen.add(orbit);"
        " for (const key of ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown']) { sweep.orbit = orbit;"
        " sweep.choose = (next) => open.push(next); sweep.key({key, preventDefault() {}}); } }"
        " delete sweep.choose; return [seen.size, sweep.report.orbits.length]; })()");
    EXPECT_EQ(reached[0], reached[1]);
    EXPECT_GT(reached[1], 20);
    // Clicks on one place go through all that lie there.
    const json clicked = page->evaluate(
        "(() => { const {sweep} = nsma, {diagram} = sweep, {plot} = diagram, {orbits} = sweep.report;"
        " const place = ({x, y}) => plot.nearest(plot.x(x), plot.y(y)).filter((point) => point.orbit);"
        " const most = orbits.map((orbit) => place(diagram.pointOf(orbit))).sort((a, b) => b.length - a.length)[0];"
        " const seen = new Set(); for (const point of most) { diagram.pickOf(most); seen.add(sweep.orbit); }"
        " return [seen.size, most.length]; })()");
    EXPECT_EQ(clicked[0], clicked[1]);
    EXPECT_GT(clicked[1], 1);
}

TEST_F(ReportPage, TheTableIsMovedThroughByKeysSortedAndFiltered) {
    open(scene_text("First mode", unit_bar, "mode = 1"), "#r=60&p=10&E=6");
    const auto selected = [&] {
        return page->evaluate("document.querySelector('#levels tr[aria-selected=true]')?.children[5].textContent");
    };
    EXPECT_EQ(selected(), "6");
    page->evaluate("document.querySelector('#levels').focus()");
    page->key("ArrowDown");
    EXPECT_EQ(selected(), "12.6");
    EXPECT_EQ(shown(), "#r=60&p=10&E=12.6");
    page->key("Home");
    EXPECT_EQ(page->evaluate("nsma.sweep.table.place"), 0);
    page->key("End");
    EXPECT_EQ(page->evaluate("nsma.sweep.table.place === nsma.sweep.table.shown.length - 1"), true);
    const auto all = page->evaluate("nsma.sweep.table.rows.length").get<int>();
    page->evaluate(
        "(() => { const box = document.querySelector('#filter'); box.value = '60 orbit';"
        " box.dispatchEvent(new Event('input')); })()");
    const std::string count = page->evaluate("document.querySelector('#count').textContent");
    EXPECT_THAT(count, testing::EndsWith(" of " + std::to_string(all) + " rows"));
    EXPECT_LT(page->evaluate("nsma.sweep.table.shown.length").get<int>(), all);
    // A filter shows its rows wherever the table was.
    page->evaluate("document.querySelector('#levels').scrollTop = 1e6; nsma.sweep.table.filter('least')");
    EXPECT_GT(page->evaluate("document.querySelectorAll('#levels tr[role=row]').length").get<int>(), 5);
    // By energy, the greatest first.
    const std::string head = "document.querySelectorAll('#levels th')[7]";
    page->evaluate(head + ".firstChild.click(), " + head + ".firstChild.click()");
    EXPECT_EQ(page->evaluate(head + ".getAttribute('aria-sort')"), "descending");
    EXPECT_EQ(
        page->evaluate("nsma.sweep.table.shown.map(({energy}) => energy).every((e, i, all) => i === 0 || e === null "
                       "|| e <= all[i - 1])"),
        true);
}

TEST_F(ReportPage, TheAnimationShowsTheBarAtItsTime) {
    open(scene_text("First mode", steel_bar, "mode = 1"), "#r=48&p=16");
    const OrbitAnswer& expected = answer(48, 16, std::nullopt);
    const int quarter = 64 / 4;
    page->evaluate("(() => { const slider = document.querySelector('#time'); slider.value = " +
                   std::to_string(quarter) + "; slider.dispatchEvent(new Event('input')); })()");
    const auto data = [&](const char* name) {
        return std::stod(
            page->evaluate("document.querySelector('#bar').dataset." + std::string(name)).get<std::string>());
    };
    EXPECT_EQ(data("time"), quarter);
    const Eigen::VectorXd tip = tip_displacement(*expected.orbit);
    EXPECT_NEAR(data("tip"), tip[quarter], 1e-12 * tip.cwiseAbs().maxCoeff());
    EXPECT_THAT(page->evaluate("document.querySelector('#moment').textContent").get<std::string>(),
                testing::HasSubstr("= 0.25 T"));
    // The cursor of the curves stands there too.
    EXPECT_NEAR(page->evaluate("nsma.sweep.curves.plots[0].posToVal(nsma.sweep.curves.plots[0].cursor.left, 'x') *"
                               " nsma.sweep.curves.toSteps")
                    .get<double>(),
                quarter, 0.5);
    page->click("#play");
    page->wait_until("Number(document.querySelector('#bar').dataset.time) > 20");
    page->click("#play");
    EXPECT_EQ(page->evaluate("nsma.sweep.animation.playing"), false);
}

TEST_F(ReportPage, NoTitleBecomesScript) {
    const std::string title =
        "</script><script>window.owned = 1</script><img src=x onerror='window.owned = 2'>\" & <b>";
    open(scene_text(title, unit_bar, "list = [[60, 10]]"));
    EXPECT_EQ(page->evaluate("document.querySelector('#title').textContent"), title);
    EXPECT_EQ(page->evaluate("window.owned === undefined"), true);
    EXPECT_EQ(page->evaluate("document.querySelectorAll('img, b').length"), 0);
}

TEST_F(ReportPage, DownloadsLoseNoDigit) {
    open(scene_text("First mode", unit_bar, "mode = 1"), "#r=60&p=10&E=12.6");
    page->evaluate(
        "(() => { window.saved = []; URL.createObjectURL = (blob) => { window.saved.push(blob);"
        " return 'blob:nothing'; }; HTMLAnchorElement.prototype.click = function () {"
        " window.saved.push(this.download); }; })()");
    page->click("#save-csv");
    const std::string csv = page->evaluate("window.saved[0].text()");
    EXPECT_EQ(page->evaluate("window.saved[1]"), "orbit-60-10-12.6.csv");
    const Eigen::VectorXd tip = tip_displacement(*answer(60, 10, 12.6).orbit);
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "t_s,x_m,force_n");
    for (Eigen::Index n = 0; n < tip.size(); ++n) {
        std::getline(lines, line);
        EXPECT_NEAR(std::stod(sample::csv_fields(line).at(1)), tip[n], 1e-12);
    }
    page->click("#save-svg");
    EXPECT_THAT(page->evaluate("window.saved[2].text()").get<std::string>(), testing::HasSubstr("<svg"));
}

TEST_F(ReportPage, FitsADeskAPhoneAndPaper) {
    open(scene_text("First mode", steel_bar, "mode = 1"), "#r=60&p=10&E=12.6");
    const auto width = [&] { return page->evaluate("document.documentElement.scrollWidth").get<int>(); };
    EXPECT_LE(width(), 1280);
    EXPECT_GT(page->screenshot().size(), 30'000U);
    const auto paper = [&] {
        return page->evaluate("getComputedStyle(document.body).backgroundColor").get<std::string>();
    };
    EXPECT_EQ(paper(), "rgb(255, 255, 255)");
    page->scheme("dark");
    EXPECT_EQ(paper(), "rgb(22, 24, 27)");
    page->click("#theme");
    EXPECT_EQ(paper(), "rgb(255, 255, 255)");
    page->scheme("light");
    page->size(390, 844, 2, true);
    EXPECT_LE(width(), 390);
    EXPECT_EQ(page->screenshot().compare(1, 3, "PNG"), 0);
    page->media("print");
    EXPECT_EQ(page->evaluate("getComputedStyle(document.querySelector('.tools')).display"), "none");
    EXPECT_EQ(page->pdf().compare(0, 4, "%PDF"), 0);
    // Paper is white whatever the theme; afterwards the theme is as it was, and so is the view.
    page->evaluate("document.querySelector('#theme').click(), nsma.sweep.animation.to(20)");
    page->evaluate("window.dispatchEvent(new Event('beforeprint'))");
    EXPECT_EQ(paper(), "rgb(255, 255, 255)");
    page->evaluate("window.dispatchEvent(new Event('afterprint'))");
    EXPECT_EQ(paper(), "rgb(22, 24, 27)");
    EXPECT_EQ(page->evaluate("nsma.sweep.animation.time"), 20);
}

TEST_F(ReportPage, WithoutAnOrbitItSaysSo) {
    scene = parse_scene(scene_text("Nothing", unit_bar, "list = [[60, 10]]"), "test");
    scene.levels = {};
    PatternRecord record;
    record.pattern = {20, 60, 10};
    record.verdict = Verdict::inadmissible;
    results = {{0, -1, record, std::nullopt}};
    sample::store(path / "sweep", scene, results);
    open_page(path / "sweep");
    EXPECT_THAT(page->evaluate("document.querySelector('#orbit').textContent").get<std::string>(),
                testing::HasSubstr("No orbit was found"));
    page->evaluate("document.querySelector('#diagram svg').focus()");
    page->key("ArrowRight");
}

TEST_F(ReportPage, OfAnAccuracyStudyNamesMethodsAndCauses) {
    std::filesystem::create_directories(path / "accuracy");
    sample::write(path / "accuracy" / "scene.toml", sample::scene_text);
    AccuracyResults study;
    for (const std::string method : {"Ipopt", "SLSQP"}) {
        ProgramRecord program;
        program.pattern = {20, 48, 16};
        program.size = 8;
        program.method = method;
        program.setting = "tol 1e-08";
        program.runs = 9;
        program.certified = 6;
        program.seconds.median = 4e-3;
        program.error = method == "Ipopt" ? 3e-10 : 0.0;
        study.add(program);
        StabilityRecord cell;
        cell.pattern = program.pattern;
        cell.method = method;
        cell.map = "level";
        cell.difficulty = "E_min (1 + 1e-12)";
        cell.runs = 4;
        cell.outcomes = {1, 0, 3, 0, 0, 0, 0};
        study.add(cell);
    }
    write_records(path / "accuracy", study);
    open_page(path / "accuracy");
    const auto text = [&](const char* selector) {
        return page->evaluate("document.querySelector('" + std::string(selector) + "').textContent").get<std::string>();
    };
    EXPECT_THAT(text("#accuracy"), testing::HasSubstr("25 % ✓, off-level"));
    EXPECT_EQ(page->evaluate("document.querySelector('#sweep')"), json());
    EXPECT_EQ(page->evaluate("document.querySelectorAll('#speed path.layer').length"), 2);
    page->click("#accuracy .legend input");
    EXPECT_EQ(page->evaluate("document.querySelectorAll('#speed path.layer').length"), 1);
    page->click("#accuracy .legend input");
    const json place = page->evaluate(
        "(() => { const plot = nsma.pages[0].plots[0], point = plot.options.layers[0].points[0];"
        " const box = plot.svg.getBoundingClientRect(); return [box.left + plot.x(point.x), box.top + "
        "plot.y(point.y)]; })()");
    page->hover(place[0], place[1]);
    EXPECT_EQ(text("#speed .hint"), "Ipopt, tol 1e-08: error 3e-10, 4 ms, 6 of 9 certified");
}

using NoReport = sample::Folder;
TEST_F(NoReport, OfNothingThereIsNoReport) {
    EXPECT_THAT(sample::error_of([&] { (void)report_page(path, ""); }),
                testing::HasSubstr("expected the folder of a sweep or of an accuracy study, got one without"));
    EXPECT_THAT(sample::error_of([&] { (void)report_page(path / "none", ""); }), testing::HasSubstr("got nothing"));
}

}  // namespace
