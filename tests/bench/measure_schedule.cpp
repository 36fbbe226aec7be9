// nsma_schedule TIMINGS.csv SOLVES SERVICE LATENCY: what rank 0 would see with 1 to 1000 ranks when the messages of a
// recorded sweep come in a fixed-seed random order until there are SOLVES answers among them. Times in seconds.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "schedule.hpp"

namespace {

// A result of its own, or verdicts with the levels outside their intervals, which travel together.
struct Message {
    double seconds = 0;
    bool answer = false;
};

// About a millisecond of verdicts is one message, as SweepQueue estimates it.
constexpr double batch_seconds = 1e-3;

std::vector<Message> recorded(const char* file) {
    std::vector<Message> messages;
    std::ifstream stream(file);
    Message batch;
    for (std::string line; std::getline(stream, line);) {
        // free_steps,contact_steps,level,what,start,status,iterations,seconds
        std::istringstream fields(line);
        std::vector<std::string> field;
        for (std::string text; std::getline(fields, text, ',');) field.push_back(text);
        if (field.size() != 8) continue;
        const double seconds = std::atof(field[7].c_str());
        const bool outside = field[5] == "below" || field[5] == "above" || field[5] == "undecided";
        if (field[3] == "answer" && !outside) {
            messages.push_back({seconds, true});
        } else if (field[3] == "answer" || field[3] == "pattern") {
            batch.seconds += seconds;
            if (batch.seconds < batch_seconds) continue;
            messages.push_back(batch);
            batch = {};
        }
    }
    if (batch.seconds > 0) messages.push_back(batch);
    return messages;
}

}  // namespace

int main(int count, char** words) {
    if (count != 5) {
        std::fprintf(stderr, "usage: nsma_schedule TIMINGS.csv SOLVES SERVICE LATENCY\n");
        return 2;
    }
    const std::vector<Message> pool = recorded(words[1]);
    if (std::none_of(pool.begin(), pool.end(), [](const Message& message) { return message.answer; })) {
        std::fprintf(stderr, "%s: expected the timings of a sweep with answers, got none\n", words[1]);
        return 2;
    }
    std::mt19937_64 random(1);
    std::vector<double> units;
    for (long left = std::max(1L, std::atol(words[2])); left > 0;) {
        const Message& message = pool[random() % pool.size()];
        units.push_back(message.seconds);
        if (message.answer) --left;
    }
    std::sort(units.rbegin(), units.rend());  // longest first
    std::printf("ranks,seconds,messages_per_second,rank_0_busy,efficiency\n");
    for (const int ranks : {1, 2, 10, 100, 300, 1000}) {
        const nsma::Schedule schedule =
            nsma::simulated_schedule(units, {ranks, std::atof(words[3]), std::atof(words[4])});
        std::printf("%d,%.3g,%.4g,%.3g,%.3g\n", ranks, schedule.seconds, schedule.message_rate, schedule.busy,
                    schedule.efficiency);
    }
    return 0;
}
