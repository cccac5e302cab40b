#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "shape/ray_body.h"
#include "shape/volume_monte_carlo.h"
#include "shape/weight_window.h"

namespace skinglow::testing {

class Random {
  public:
    explicit Random(std::uint64_t seed, std::uint64_t stream) {
        std::seed_seq sequence{seed & 0xffffffffU, seed >> 32U, stream};
        generator_.seed(sequence);
    }
    double operator()() { return (static_cast<double>(generator_() >> 11U) + 0.5) * 0x1p-53; }  // in (0, 1)

  private:
    std::mt19937_64 generator_;
};

/// One block of photons.
struct Tally {
    std::vector<double> flux;  ///< per vertex
    double entered = 0;
    double left = 0;
    double absorbed = 0;
    double lost = 0;
};

/// Of diffuse light that strikes a smooth surface from outside: the share that it reflects.
double diffuse_reflection(double refractive_index);

/// Follows photons through a body. What it is given must outlive it.
class Walk {
  public:
    /// @param unit_weight  of a photon that starts, in the unit of flux
    Walk(const RayBody& body, const TurbidMedium& medium, const WeightWindow& window, double unit_weight,
         Random random, Tally& tally);

    /// Light that strikes a point of the surface, and all that comes of it.
    void start(std::uint32_t triangle, const glm::dvec3& position, double weight);

  private:
    struct Photon {
        glm::dvec3 position;
        glm::dvec3 direction;
        double weight;
        int bodies;              ///< that it is inside of
        std::uint32_t triangle;  ///< that it stands on
    };

    void follow(Photon photon);
    double inner_reflection(double cosine) const;
    void leave(std::uint32_t triangle, const glm::dvec3& point, double weight);
    bool collide(Photon& photon);
    double scattering_cosine();

    const RayBody& body_;
    const TurbidMedium& medium_;
    const WeightWindow& window_;
    Random random_;
    Tally& tally_;
    double extinction_;
    double reflection_;
    double inner_reflection_;
    double unit_weight_;
    std::vector<Photon> stack_;
};

}  // namespace skinglow::testing
