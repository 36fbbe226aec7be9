// nsma_schedule TIMINGS.csv SOLVES SERVICE LATENCY: what rank 0 would see with 1 to 1000 ranks when the units of a
// recorded sweep come in a fixed-seed random order until there are SOLVES of them. Times in seconds.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "nsma/study/schedule.hpp"

namespace {

// Seconds of every pattern and answer: the fields `what` and the last one.
std::vector<double> recorded(const char* file) {
    std::vector<double> seconds;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream fields(line);
        std::string field, what;
        for (int i = 0; std::getline(fields, field, ','); ++i) {
            if (i == 3) what = field;
        }
        if (what == "pattern" || what == "answer") seconds.push_back(std::atof(field.c_str()));
    }
    return seconds;
}

}  // namespace

int main(int count, char** words) {
    if (count != 5) {
        std::fprintf(stderr, "usage: nsma_schedule TIMINGS.csv SOLVES SERVICE LATENCY\n");
        return 2;
    }
    const std::vector<double> pool = recorded(words[1]);
    if (pool.empty()) {
        std::fprintf(stderr, "%s: expected the timings of a sweep, got none\n", words[1]);
        return 2;
    }
    std::mt19937_64 random(1);
    std::vector<double> units(static_cast<std::size_t>(std::max(1L, std::atol(words[2]))));
    for (double& unit : units) unit = pool[random() % pool.size()];
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
