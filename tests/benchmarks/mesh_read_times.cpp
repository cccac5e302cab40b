// Times of reading mesh files: mesh_read_times FILE... prints for each the number of triangles, seconds by the clock and
// of processor time (the best of ten each) and the peak of the process's memory so far in MB.

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>

#include "files/mesh_file.h"

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        double best = 1e9;
        double best_cpu = 1e9;
        std::size_t triangles = 0;
        for (int k = 0; k < 10; ++k) {
            const auto start = std::chrono::steady_clock::now();
            const std::clock_t cpu_start = std::clock();
            triangles = skinglow::detail::read_mesh(argv[i]).mesh.triangles().size();
            best_cpu = std::min(best_cpu, static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC);
            best = std::min(best,
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        // Not getrusage, whose peak is the parent's where that was larger.
        long peak_kb = 0;
        std::ifstream status("/proc/self/status");
        for (std::string word; status >> word && word != "VmHWM:";) continue;
        status >> peak_kb;
        std::cout << argv[i] << " " << triangles << " " << best << " " << best_cpu << " " << peak_kb / 1024
                  << "\n";
    }
}
