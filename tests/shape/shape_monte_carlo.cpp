// shape_monte_carlo INPUT OUTPUT: exitance of a lit body by brute force, for studies/monte_carlo.py, where
// reference.py writes INPUT and reads OUTPUT. Little-endian, without padding:
// INPUT   int64 vertices, triangles, channels, targets, photons per channel, seed, threads; for each
//         channel double absorption, scattering (1/mm), anisotropy, refractive index, rough (0 or 1);
//         double positions (mm); uint32 corners; for each channel double irradiance by vertex;
//         uint32 targets.
// OUTPUT  for each channel double incident, entered, left, absorbed, lost flux and by vertex the two halves
//         of the exitance.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "shape/volume_monte_carlo.h"

namespace {

using skinglow::testing::Exitance;
using skinglow::testing::TurbidMedium;

class Reader {
  public:
    explicit Reader(const char* path) : file_(path, std::ios::binary) {}

    template <typename Value>
    std::vector<Value> read(std::int64_t count) {
        std::vector<Value> values(static_cast<std::size_t>(count));
        if (!file_.read(reinterpret_cast<char*>(values.data()),
                        static_cast<std::streamsize>(values.size() * sizeof(Value)))) {
            throw std::runtime_error("the input ends too early, or cannot be read");
        }
        return values;
    }

  private:
    std::ifstream file_;
};

void write(std::ofstream& file, const std::vector<double>& values) {
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(double)));
}

void run(const char* input, const char* output) {
    Reader reader(input);
    const std::vector<std::int64_t> header = reader.read<std::int64_t>(7);
    const std::int64_t vertices = header[0];
    const std::int64_t channels = header[2];
    const std::vector<double> media = reader.read<double>(5 * channels);
    const auto points = reader.read<glm::dvec3>(vertices);
    const auto triangles = reader.read<glm::uvec3>(header[1]);
    std::vector<std::vector<double>> irradiance;
    for (std::int64_t c = 0; c < channels; ++c) irradiance.push_back(reader.read<double>(vertices));
    const auto targets = reader.read<std::uint32_t>(header[3]);

    std::ofstream file(output, std::ios::binary);
    for (std::size_t c = 0; c < irradiance.size(); ++c) {
        const double* const medium = &media[5 * c];
        const Exitance exitance = volume_monte_carlo(points, triangles, irradiance[c],
                                                     TurbidMedium{.absorption = medium[0],
                                                                  .scattering = medium[1],
                                                                  .anisotropy = medium[2],
                                                                  .refractive_index = medium[3],
                                                                  .rough = medium[4] != 0},
                                                     {.photons = header[4],
                                                      .seed = static_cast<std::uint64_t>(header[5]) + c,
                                                      .threads = static_cast<int>(header[6]),
                                                      .targets = targets});
        write(file, {exitance.incident, exitance.entered, exitance.left, exitance.absorbed, exitance.lost});
        for (const std::vector<double>& half : exitance.half) write(file, half);
    }
    if (!file.flush()) throw std::runtime_error("the output cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 3) throw std::runtime_error("usage: shape_monte_carlo INPUT OUTPUT");
        run(argv[1], argv[2]);
    } catch (const std::exception& error) {
        std::cerr << "shape_monte_carlo: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
