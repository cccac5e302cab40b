// Times of reading mesh files: mesh_read_times FILE... prints for each seconds (the best of three) and the peak of the
// process's memory so far in MB.

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <string>

#include "files/mesh_file.h"

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        double best = 1e9;
        std::size_t triangles = 0;
        for (int k = 0; k < 3; ++k) {
            const auto start = std::chrono::steady_clock::now();
            triangles = skinglow::read_mesh(argv[i]).mesh.triangles().size();
            best = std::min(best,
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        // Not getrusage, whose peak is the parent's where that was larger.
        long peak_kb = 0;
        std::ifstream status("/proc/self/status");
        for (std::string word; status >> word && word != "VmHWM:";) continue;
        status >> peak_kb;
        std::cout << argv[i] << " " << triangles << " " << best << " " << peak_kb / 1024 << "\n";
    }
}
