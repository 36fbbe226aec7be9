#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "process.hpp"

/// Pages in a headless Chromium, which is spoken to in the DevTools protocol. Nothing here waits without a limit.
namespace browser {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

inline Clock::time_point seconds_from_now(double seconds) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// NSMA_CHROMIUM (empty: none, tests of pages are skipped), or else the first in PATH.
inline std::optional<std::string> program() {
    if (const char* given = std::getenv("NSMA_CHROMIUM")) {
        return *given == '\0' ? std::nullopt : std::optional<std::string>(given);
    }
    const char* path = std::getenv("PATH");
    for (const char* name : {"/chromium", "/chromium-browser", "/google-chrome"}) {
        std::istringstream folders(path == nullptr ? "" : path);
        for (std::string folder; std::getline(folders, folder, ':');) {
            if (access((folder + name).c_str(), X_OK) == 0) return folder + name;
        }
    }
    return std::nullopt;
}

inline std::string decode_base64(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char character : text.substr(0, text.find('='))) {
        const auto digit = digits.find(character);
        if (digit == std::string_view::npos) throw std::runtime_error("not base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
    }
    return bytes;
}

/// KeyboardEvent's code and keyCode on an American keyboard, whether Shift is down, and what the key writes.
struct Key {
    std::string code;
    int number;
    bool shift;
    std::string text;
};

/// A printable character of ASCII, or a name as in KeyboardEvent.key.
inline Key key_named(const std::string& name) {
    static const std::map<std::string, int> named{
        {"Backspace", 8},   {"Tab", 9},        {"Enter", 13}, {"Escape", 27},    {"PageUp", 33},
        {"PageDown", 34},   {"End", 35},       {"Home", 36},  {"ArrowLeft", 37}, {"ArrowUp", 38},
        {"ArrowRight", 39}, {"ArrowDown", 40}, {"Delete", 46}};
    if (const auto found = named.find(name); found != named.end()) {
        return {name, found->second, false, name == "Enter" ? "\r" : ""};
    }
    constexpr std::string_view plain = "0123456789abcdefghijklmnopqrstuvwxyz `-=[]\\;',./";
    constexpr std::string_view shifted = ")!@#$%^&*(ABCDEFGHIJKLMNOPQRSTUVWXYZ ~_+{}|:\"<>?";
    constexpr std::array codes{"Space",     "Backquote", "Minus", "Equal", "BracketLeft", "BracketRight",
                               "Backslash", "Semicolon", "Quote", "Comma", "Period",      "Slash"};
    constexpr std::array numbers{32, 192, 189, 187, 219, 221, 220, 186, 222, 188, 190, 191};
    const bool shift = plain.find(name) == std::string_view::npos;
    const auto place = (shift ? shifted : plain).find(name);
    if (name.size() != 1 || place == std::string_view::npos) throw std::runtime_error("no key is named " + name);
    if (place < 10) return {"Digit" + std::to_string(place), '0' + static_cast<int>(place), shift, name};
    if (place < 36) return {std::string("Key") + shifted[place], shifted[place], shift, name};
    return {codes.at(place - 36), numbers.at(place - 36), shift, name};
}

/// A running Chromium and the socket that is its DevTools "pipe", 3 to read and 4 to write: messages of JSON, each with
/// a NUL at its end. If the test dies, the socket is closed and Chromium ends by itself.
class Process {
public:
    Process() {
        const auto file = program();
        if (!file) throw std::runtime_error("no chromium: set NSMA_CHROMIUM");
        const std::string folder = folder_.path().string();
        // HOME and TMPDIR: else it leaves files there.
        std::vector<std::string> words{"env", "HOME=" + folder, "TMPDIR=" + folder, *file, "--user-data-dir=" + folder};
        // Root in a container has no sandbox. The proxy does not exist: nothing is reached, whatever a page asks for.
        std::istringstream options(
            "--headless=new --remote-debugging-pipe --no-startup-window --no-sandbox --disable-gpu "
            "--disable-dev-shm-usage --no-first-run --no-default-browser-check --disable-background-networking "
            "--disable-component-update --disable-default-apps --disable-extensions --disable-sync --disable-breakpad "
            "--disable-features=SpareRendererForSitePerProcess,PreloadTopChromeWebUI --proxy-server=127.0.0.1:9 "
            "--password-store=basic --mute-audio --force-color-profile=srgb --lang=en-US");
        for (std::string option; options >> option;) words.push_back(option);
        std::vector<char*> pointers;
        for (auto& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);

        std::array<int, 2> ends{};
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
            throw std::runtime_error("no socket for chromium");
        }
        child_ = fork();
        if (child_ == 0) {
            setpgid(0, 0);
            // First out of the way of 3 and 4, which they may be already.
            const int theirs = fcntl(ends[1], F_DUPFD_CLOEXEC, 10);
            const int log = fcntl(::open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), F_DUPFD_CLOEXEC, 10);
            dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
            dup2(log, STDOUT_FILENO);
            dup2(log, STDERR_FILENO);
            dup2(theirs, 3);
            dup2(theirs, 4);
            execvp(pointers[0], pointers.data());
            _exit(127);
        }
        close(ends[1]);
        socket_ = ends[0];
        if (child_ < 0) {
            close(socket_);
            throw std::runtime_error("cannot fork for chromium");
        }
        setpgid(child_, child_);  // here too: the destructor must find the group
    }

    /// Asks it to end, by which the socket is closed; kills what is left.
    ~Process() {
        const auto end = seconds_from_now(20);
        try {
            send({{"id", 0}, {"method", "Browser.close"}}, end);
            while (true) receive(end, "its end");
        } catch (const std::exception&) {
        }
        close(socket_);
        const std::chrono::duration<double> left = end - Clock::now();
        process::wait_for([&] { return process::ended(child_); }, left.count());
        kill(-child_, SIGKILL);
        process::finish(child_);
        // Others of its group may still be dying, and writing into the folder.
        std::error_code code;
        process::wait_for([&] { return std::filesystem::remove_all(folder_.path(), code), !code; }, 2);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(const Json& message, Clock::time_point end) {
        const std::string text = message.dump() + '\0';
        for (std::size_t sent = 0; sent < text.size();) {
            await(POLLOUT, end, "to be listened to");
            // Into a pipe whose reader has died this would be SIGPIPE, the end of the test: hence a socket.
            const auto count = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (count < 0 && errno != EINTR && errno != EAGAIN) fail("ended, awaited was to be listened to");
            if (count > 0) sent += static_cast<std::size_t>(count);
        }
    }

    Json receive(Clock::time_point end, const std::string& awaited) {
        std::size_t searched = 0;
        std::size_t size = 0;
        while ((size = buffer_.find('\0', searched)) == std::string::npos) {
            searched = buffer_.size();
            await(POLLIN, end, awaited);
            std::array<char, 1 << 16> chunk{};
            const auto count = recv(socket_, chunk.data(), chunk.size(), MSG_DONTWAIT);
            if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) fail("ended, awaited was " + awaited);
            if (count > 0) buffer_.append(chunk.data(), static_cast<std::size_t>(count));
        }
        Json message = Json::parse(std::string_view(buffer_).substr(0, size));
        buffer_.erase(0, size + 1);
        return message;
    }

private:
    void await(short event, Clock::time_point end, const std::string& awaited) const {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd ready{socket_, event, 0};
        // No look without time left: else a page that reports events for ever is listened to for ever.
        if (left <= 0 || poll(&ready, 1, static_cast<int>(left)) == 0) fail("too slow, awaited was " + awaited);
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw std::runtime_error("chromium: " + what.substr(0, 400) + "\n" + process::contents(log_).substr(0, 2000));
    }

    process::Folder folder_;
    std::filesystem::path log_ = folder_.path() / "log";
    pid_t child_ = -1;
    int socket_ = -1;
    std::string buffer_;
};

/// The page was left for another document before it answered.
struct Left : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// One page in a browser of its own. What acts on it returns after two frames: handlers have run, it is laid out anew.
class Page {
public:
    double limit = 60;  ///< seconds of any wait, then it throws; far too many, as machines with sanitizers are slow

    Page() {
        target_ = call_in("", "Target.createTarget", {{"url", "about:blank"}}).at("targetId");
        session_ = call_in("", "Target.attachToTarget", {{"targetId", target_}, {"flatten", true}}).at("sessionId");
        for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(std::string(domain) + ".enable");
        call("Page.setLifecycleEventsEnabled", {{"enabled", true}});
        call("Emulation.setFocusEmulationEnabled", {{"enabled", true}});  // keys go to the page
    }

    /// In pixels of CSS, each of them `scale` by `scale` in a screenshot. `mobile`: heeds the page's meta viewport.
    void size(int width, int height, double scale = 1, bool mobile = false) {
        call("Emulation.setDeviceMetricsOverride",
             {{"width", width}, {"height", height}, {"deviceScaleFactor", scale}, {"mobile", mobile}});
        settle();
    }
    /// "dark" or "light".
    void scheme(const std::string& dark_or_light) { emulate(media_, scheme_ = dark_or_light); }
    /// "print" or "screen".
    void media(const std::string& print_or_screen) { emulate(media_ = print_or_screen, scheme_); }

    /// Up to the load event. Another fragment of the document that is open does not load it again, as in any browser;
    /// for that open about:blank in between.
    void open(const std::string& url) {
        opening_ = true;
        const Json answer = call("Page.navigate", {{"url", url}});
        if (answer.contains("errorText")) throw std::runtime_error(url + ": " + answer.at("errorText").dump());
        if (answer.contains("loaderId")) {  // a new document
            shown_ = answer.at("loaderId");
            for (const auto end = seconds_from_now(limit); loaded_ != shown_;) {
                take(browser_.receive(end, "the load event of " + url));
            }
        }
        opening_ = false;
        settle();
    }

    /// Its value, or that of its promise. Doubles come back as they are (a -0 inside of something as 0), a bigint as
    /// text ("12n"), undefined as null.
    Json evaluate(const std::string& expression) {
        const Json answer =
            call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
        if (answer.contains("exceptionDetails")) throw std::runtime_error(text_of(answer.at("exceptionDetails")));
        const Json& result = answer.at("result");
        if (!result.contains("unserializableValue")) return result.value("value", Json());
        const std::string text = result.at("unserializableValue");
        if (result.at("type") == "bigint") return text;
        return std::strtod(text.c_str(), nullptr);  // NaN, Infinity, -Infinity, -0
    }

    /// Two frames: callbacks of the first have run, observers of its layout too.
    void settle() { insist("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done())))"); }
    /// Looks every other frame until the expression is true.
    void wait_until(const std::string& expression) {
        for (const auto end = seconds_from_now(limit); insist("!!(" + expression + ")") != true; settle()) {
            if (Clock::now() > end) throw std::runtime_error("the page is not yet " + expression);
        }
    }

    void key(const std::string& name, bool shift = false) {
        const Key key = key_named(name);
        Json event = {{"key", name}, {"code", key.code}, {"windowsVirtualKeyCode", key.number}};
        event["modifiers"] = shift || key.shift ? 8 : 0;
        event["type"] = key.text.empty() ? "rawKeyDown" : "keyDown";
        event["text"] = key.text;
        call("Input.dispatchKeyEvent", event);
        event["type"] = "keyUp";
        event.erase("text");
        call("Input.dispatchKeyEvent", event);
        settle();
    }

    void hover(double x, double y) {
        mouse("mouseMoved", x, y, 0);
        settle();
    }
    void click(double x, double y) { drag(x, y, x, y, 0); }
    /// The middle of the first such element, after scrolling to it.
    void click(const std::string& selector) {
        const Json at = evaluate(
            "(selector => { const element = document.querySelector(selector);"
            "if (!element || !element.getClientRects().length) return null;"
            "element.scrollIntoView({block: 'center', inline: 'center', behavior: 'instant'});"
            "const box = element.getBoundingClientRect();"
            "return [box.x + box.width / 2, box.y + box.height / 2]; })(" +
            Json(selector).dump() + ")");
        if (at.is_null()) throw std::runtime_error("the page shows no " + selector);
        click(at.at(0), at.at(1));
    }
    /// With the left button from one point to another, in `steps` moves.
    void drag(double from_x, double from_y, double to_x, double to_y, int steps = 10) {
        mouse("mouseMoved", from_x, from_y, 0);
        mouse("mousePressed", from_x, from_y, 1);
        for (int step = 1; step <= steps; ++step) {
            const double part = static_cast<double>(step) / steps;
            mouse("mouseMoved", from_x + part * (to_x - from_x), from_y + part * (to_y - from_y), 1);
        }
        mouse("mouseReleased", to_x, to_y, 0);
        settle();
    }

    /// What is seen of the page, as PNG.
    std::string screenshot() { return bytes_of(call("Page.captureScreenshot")); }
    /// The page as printed with its backgrounds on the paper that its style asks for.
    std::string pdf() {
        return bytes_of(call("Page.printToPDF", {{"printBackground", true}, {"preferCSSPageSize", true}}));
    }

    /// What should fail a test, since the start or forget(): uncaught exceptions; console.error, .assert, .warn; errors
    /// that the browser reports, as of requests that failed; dialogs, which are accepted at once.
    const std::vector<std::string>& errors() {
        settle();  // by its answer the page has told what came before
        return errors_;
    }
    /// All addresses asked for, since the start or forget(), but for the documents of open(), data: and blob:.
    const std::vector<std::string>& requests() {
        settle();
        return requests_;
    }
    void forget() {
        settle();
        errors_.clear();
        requests_.clear();
    }

    /// What scripts hold after a collection of garbage.
    double heap_bytes() {
        call("HeapProfiler.collectGarbage");
        return call("Runtime.getHeapUsage").at("usedSize");
    }
    /// Resident memory of all renderers: of the page's and of one that Chromium keeps for its own window.
    double memory_bytes() {
        double pages = 0;
        const Json answer = call_in("", "SystemInfo.getProcessInfo");
        for (const auto& info : answer.at("processInfo")) {
            if (info.at("type") != "renderer") continue;
            std::ifstream statm("/proc/" + info.at("id").dump() + "/statm");
            double all = 0;
            double resident = 0;
            if (statm >> all >> resident) pages += resident;
        }
        return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
    }

    /// Any other method of the protocol.
    Json call(const std::string& method, const Json& parameters = Json::object()) {
        return call_in(session_, method, parameters);
    }

private:
    int post(const std::string& session, const std::string& method, const Json& parameters, Clock::time_point end) {
        if (crashed_) throw std::runtime_error("the page has crashed");
        Json message = {{"id", ++last_id_}, {"method", method}, {"params", parameters}};
        if (!session.empty()) message["sessionId"] = session;
        browser_.send(message, end);
        return last_id_;
    }

    Json call_in(const std::string& session, const std::string& method, const Json& parameters = Json::object()) {
        const auto end = seconds_from_now(limit);
        const int id = post(session, method, parameters, end);
        const std::string awaited = "the answer to " + method + " " + parameters.dump();
        while (true) {
            const Json message = browser_.receive(end, awaited);
            take(message);
            if (message.value("id", 0) != id) continue;
            if (!message.contains("error")) return message.at("result");
            const std::string error = method + ": " + message.at("error").dump();
            if (error.find("Inspected target navigated") != std::string::npos) throw Left(error);
            throw std::runtime_error(error);
        }
    }

    /// Evaluates, in the next document if this one is left meanwhile, as it may be after a click.
    Json insist(const std::string& expression) {
        for (const auto end = seconds_from_now(limit);;) {
            try {
                return evaluate(expression);
            } catch (const Left&) {
                if (Clock::now() > end) throw;
            }
        }
    }

    /// Remembers what an event says.
    void take(const Json& message) {
        const std::string method = message.value("method", "");
        const Json event = message.value("params", Json::object());
        if (method == "Runtime.exceptionThrown") {
            errors_.push_back(text_of(event.at("exceptionDetails")));
        } else if (method == "Runtime.consoleAPICalled") {
            const std::string type = event.at("type");
            if (type != "error" && type != "assert" && type != "warning") return;
            errors_.push_back("console." + type + ":");
            for (const auto& argument : event.at("args")) errors_.back() += " " + text_of(argument);
        } else if (method == "Log.entryAdded" && event.at("entry").at("level") == "error") {
            errors_.push_back(event.at("entry").value("text", "") + " " + event.at("entry").value("url", ""));
        } else if (method == "Page.javascriptDialogOpening") {
            errors_.push_back("dialog: " + event.at("message").get<std::string>());
            post(session_, "Page.handleJavaScriptDialog", {{"accept", true}}, seconds_from_now(limit));
        } else if (method == "Network.requestWillBeSent" || method == "Network.webSocketCreated") {
            const bool document = event.value("type", "") == "Document" && event.value("frameId", "") == target_;
            if (document && std::exchange(opening_, false)) return;
            const std::string url = event.value("request", event).at("url");
            if (!url.starts_with("data:") && !url.starts_with("blob:")) requests_.push_back(url);
        } else if (method == "Page.frameNavigated" && event.at("frame").at("id") == target_) {
            shown_ = event.at("frame").at("loaderId");
        } else if (method == "Page.lifecycleEvent" && event.at("frameId") == target_ && event.at("name") == "load") {
            loaded_ = event.at("loaderId");
        } else if (method == "Inspector.targetCrashed") {
            crashed_ = true;
            throw std::runtime_error("the page has crashed");
        }
    }

    /// Of a Runtime.ExceptionDetails or a Runtime.RemoteObject.
    static std::string text_of(const Json& object) {
        if (object.contains("exceptionId")) {
            const std::string what = object.contains("exception") ? ": " + text_of(object.at("exception")) : "";
            const std::string line = std::to_string(object.at("lineNumber").get<int>() + 1);
            return object.value("text", "") + what + " (" + object.value("url", "") + ":" + line + ")";
        }
        if (object.contains("description")) return object.at("description");
        const Json value = object.value("value", object.at("type"));
        return value.is_string() ? value.get<std::string>() : value.dump();
    }

    static std::string bytes_of(const Json& answer) { return decode_base64(answer.at("data").get<std::string>()); }

    void emulate(const std::string& media, const std::string& scheme) {
        const Json feature = {{"name", "prefers-color-scheme"}, {"value", scheme}};
        call("Emulation.setEmulatedMedia", {{"media", media}, {"features", Json::array({feature})}});
        settle();
    }

    void mouse(const std::string& type, double x, double y, int buttons) {
        const bool moved = type == "mouseMoved";
        Json event = {{"type", type}, {"x", x}, {"y", y}, {"buttons", buttons}, {"clickCount", moved ? 0 : 1}};
        event["button"] = moved && buttons == 0 ? "none" : "left";
        call("Input.dispatchMouseEvent", event);
    }

    Process browser_;
    std::string target_, session_;  // the target's name is also that of its main frame
    std::string shown_, loaded_;    // the document in the main frame, the last that had its load event
    std::string media_, scheme_;
    std::vector<std::string> errors_, requests_;
    int last_id_ = 0;
    bool opening_ = false;  // the next document asked for is that of open()
    bool crashed_ = false;
};

}  // namespace browser
