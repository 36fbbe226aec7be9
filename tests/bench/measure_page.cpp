// nsma_measure_page FILE.html: opens it in a browser and prints time to its load event [s], to its first orbit drawn
// [s], memory of its scripts [MB] and of the browser's process for it [MB].

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "../support/browser.hpp"

int main(int count, char** words) {
    if (count != 2 || !browser::program()) {
        std::fprintf(stderr, "usage: nsma_measure_page FILE.html, with chromium installed\n");
        return 2;
    }
    browser::Page page;
    page.size(1280, 800);
    page.open("about:blank");
    const auto begin = std::chrono::steady_clock::now();
    page.open("file://" + std::filesystem::absolute(words[1]).string());
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    const double loaded =
        page.evaluate("performance.timing.loadEventEnd - performance.timing.navigationStart").get<double>();
    std::printf("%.3f,%.3f,%.1f,%.1f\n", 1e-3 * loaded, wall.count(), 1e-6 * page.heap_bytes(),
                1e-6 * page.memory_bytes());
    return 0;
}
