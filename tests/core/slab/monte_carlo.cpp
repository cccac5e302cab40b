#include "monte_carlo.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

namespace skinglow::testing {
namespace {

using Generator = std::mt19937_64;

double uniform(Generator& generator) {  // in (0, 1)
    return (static_cast<double>(generator() >> 11U) + 0.5) * 0x1p-53;
}

class Tally {
  public:
    void add(double value) {
        sum_ += value;
        squares_ += value * value;
    }
    Estimate over(int photons) const {
        const double mean = sum_ / photons;
        const double variance = std::max(0.0, squares_ / photons - mean * mean);
        return {mean, std::sqrt(variance / (photons - 1))};
    }

  private:
    double sum_ = 0;
    double squares_ = 0;
};

struct Packet {
    double cosine;     // to the downward normal
    double depth = 0;  // below the top of its layer, mm
    int layer = 0;
    double weight = 1;
    bool scattered = false;
};

class Walk {
  public:
    Walk(std::span<const Layer> layers, double n_above, double n_below, std::uint64_t seed)
        : layers_(layers), n_above_(n_above), n_below_(n_below), generator_(seed) {}

    double draw() { return uniform(generator_); }

    // Follows one packet to its end; what it leaves where.
    struct Fate {
        double reflected = 0;
        double transmitted = 0;
        double unscattered = 0;
        std::vector<double> absorbed;
    };
    Fate follow(double cosine_outside) {
        Fate fate;
        fate.absorbed.assign(layers_.size(), 0);
        Packet packet{cosine_outside};
        packet.layer = -1;
        meet_boundary(packet);
        while (packet.weight > 0) {
            if (packet.layer < 0) {
                fate.reflected += packet.weight;
                break;
            }
            if (packet.layer == static_cast<int>(layers_.size())) {
                fate.transmitted += packet.weight;
                if (!packet.scattered) fate.unscattered += packet.weight;
                break;
            }
            step(packet, fate);
        }
        return fate;
    }

  private:
    double index(int layer) const {
        if (layer < 0) return n_above_;
        if (layer == static_cast<int>(layers_.size())) return n_below_;
        return layers_[static_cast<std::size_t>(layer)].refractive_index;
    }

    // At the face that the packet moves towards: it is mirrored, or refracted into the next medium.
    void meet_boundary(Packet& packet) {
        const int next = packet.layer + (packet.cosine > 0 ? 1 : -1);
        const double n = index(packet.layer);
        const double n_next = index(next);
        const double c = std::abs(packet.cosine);
        const double sine = n / n_next * std::sqrt(std::max(0.0, 1 - c * c));
        double reflectance = 1;
        double c_next = 0;
        if (sine < 1) {
            c_next = std::sqrt(1 - sine * sine);
            const double s = (n * c - n_next * c_next) / (n * c + n_next * c_next);
            const double p = (n * c_next - n_next * c) / (n * c_next + n_next * c);
            reflectance = (s * s + p * p) / 2;
        }
        if (reflectance > 0 && draw() < reflectance) {
            packet.cosine = -packet.cosine;
            return;
        }
        const bool down = packet.cosine > 0;
        packet.cosine = down ? c_next : -c_next;
        packet.layer = next;
        const bool inside = next >= 0 && next < static_cast<int>(layers_.size());
        if (inside) packet.depth = down ? 0 : layers_[static_cast<std::size_t>(next)].thickness;
    }

    void step(Packet& packet, Fate& fate) {
        const Layer& layer = layers_[static_cast<std::size_t>(packet.layer)];
        const double attenuation = layer.absorption + layer.scattering;
        const double to_face = packet.cosine > 0 ? (layer.thickness - packet.depth) / packet.cosine
                                                 : packet.depth / -packet.cosine;
        const double free_path =
            attenuation > 0 ? -std::log(draw()) / attenuation : std::numeric_limits<double>::infinity();
        if (free_path >= to_face) {
            packet.depth = packet.cosine > 0 ? layer.thickness : 0;
            meet_boundary(packet);
            return;
        }
        packet.depth += free_path * packet.cosine;
        const double lost = packet.weight * layer.absorption / attenuation;
        fate.absorbed[static_cast<std::size_t>(packet.layer)] += lost;
        packet.weight -= lost;
        packet.scattered = true;
        turn(packet, layer.anisotropy);
        if (packet.weight < 1e-3) packet.weight = draw() < 0.1 ? packet.weight * 10 : 0;
    }

    void turn(Packet& packet, double g) {
        double scatter = 2 * draw() - 1;
        if (std::abs(g) > 1e-6) {
            const double fraction = (1 - g * g) / (1 + g * scatter);
            scatter = (1 + g * g - fraction * fraction) / (2 * g);
        }
        const double azimuth = 2 * std::numbers::pi * draw();
        const double across = std::sqrt(std::max(0.0, 1 - packet.cosine * packet.cosine)) *
                              std::sqrt(std::max(0.0, 1 - scatter * scatter));
        packet.cosine = std::clamp(packet.cosine * scatter + across * std::cos(azimuth), -1.0, 1.0);
        if (packet.cosine == 0) packet.cosine = 1e-12;  // would stay at its depth for ever
    }

    std::span<const Layer> layers_;
    double n_above_;
    double n_below_;
    Generator generator_;
};

}  // namespace

MonteCarloResult monte_carlo_slab(std::span<const Layer> layers, Incidence incidence, double n_above,
                                  double n_below, int photons, std::uint64_t seed) {
    Walk walk(layers, n_above, n_below, seed);
    Tally reflected;
    Tally transmitted;
    Tally unscattered;
    std::vector<Tally> absorbed(layers.size());
    for (int i = 0; i < photons; ++i) {
        double cosine = incidence.mu0;
        if (incidence.kind == Incidence::Kind::normal) cosine = 1;
        if (incidence.kind == Incidence::Kind::diffuse) cosine = std::sqrt(walk.draw());
        const Walk::Fate fate = walk.follow(cosine);
        reflected.add(fate.reflected);
        transmitted.add(fate.transmitted);
        unscattered.add(fate.unscattered);
        for (std::size_t j = 0; j < layers.size(); ++j) absorbed[j].add(fate.absorbed[j]);
    }
    MonteCarloResult result{
        reflected.over(photons), transmitted.over(photons), unscattered.over(photons), {}};
    for (const Tally& tally : absorbed) result.absorbed.push_back(tally.over(photons));
    return result;
}

}  // namespace skinglow::testing
