// Times of reading a mesh file: mesh_read_times SMALL_FILE FILE reads the small one, so that all code is loaded, and then
// the other once, as a program does. It prints the number of triangles, seconds by the clock and of processor time, and the
// peak of the process's memory in MB.

#include <chrono>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>

#include "files/mesh_file.h"

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    skinglow::detail::read_mesh(argv[1]);
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    const auto file = skinglow::detail::read_mesh(argv[2]);
    const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // Not getrusage, whose peak is the parent's where that was larger.
    long peak_kb = 0;
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word && word != "VmHWM:";) continue;
    status >> peak_kb;
    std::cout << file.mesh.triangles().size() << " " << seconds << " " << cpu << " " << peak_kb / 1024
              << "\n";
}
