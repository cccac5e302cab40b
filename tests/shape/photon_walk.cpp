#include "shape/photon_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"

namespace skinglow::testing {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

glm::dvec3 around(const glm::dvec3& axis, double cosine, double turn) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double angle = 2.0 * std::numbers::pi * turn;
    return glm::normalize(frame_around(axis) *
                          glm::dvec3(sine * std::cos(angle), sine * std::sin(angle), cosine));
}

glm::dvec3 cosine_direction(const glm::dvec3& axis, Random& random) {
    return around(axis, std::sqrt(random()), random());
}

/// Share of unpolarized light that a smooth surface reflects, and the cosine on its other side.
struct Fresnel {
    double reflected = 1;
    double cosine = 0;

    /// @param ratio   index on this side over that on the other
    /// @param cosine_here  to the normal, 0 to 1
    Fresnel(double ratio, double cosine_here) {
        const double square = 1.0 - ratio * ratio * (1.0 - cosine_here * cosine_here);
        if (square <= 0) return;
        cosine = std::sqrt(square);
        const double s = (ratio * cosine_here - cosine) / (ratio * cosine_here + cosine);
        const double p = (cosine_here - ratio * cosine) / (cosine_here + ratio * cosine);
        reflected = 0.5 * (s * s + p * p);
    }
};

}  // namespace

double diffuse_reflection(double refractive_index) {
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double cosine = (i + 0.5) / steps;
        sum += 2.0 * cosine * Fresnel(1.0 / refractive_index, cosine).reflected / steps;
    }
    return sum;
}

Walk::Walk(const RayBody& body, const TurbidMedium& medium, const WeightWindow& window, double unit_weight,
           Random random, Tally& tally)
    : body_(body),
      medium_(medium),
      window_(window),
      random_(random),
      tally_(tally),
      extinction_(medium.absorption + medium.scattering),
      reflection_(medium.refractive_index == 1.0 ? 0.0 : diffuse_reflection(medium.refractive_index)),
      // From inside, diffuse light comes through n^2 times less: so it is in balance with the light outside.
      inner_reflection_(1.0 - (1.0 - reflection_) / (medium.refractive_index * medium.refractive_index)),
      unit_weight_(unit_weight) {}

void Walk::start(std::uint32_t triangle, const glm::dvec3& position, double weight) {
    const glm::dvec3& normal = body_.normal(triangle);
    glm::dvec3 direction = cosine_direction(-normal, random_);
    if (medium_.refractive_index != 1.0) {
        const double ratio = 1.0 / medium_.refractive_index;
        const double cosine = -glm::dot(direction, normal);
        const Fresnel smooth(ratio, cosine);
        if (random_() < (medium_.rough ? reflection_ : smooth.reflected)) return;
        if (!medium_.rough)
            direction = glm::normalize((direction + normal * cosine) * ratio - normal * smooth.cosine);
    }
    tally_.entered += weight;
    stack_.push_back({position, direction, weight, 1, triangle});
    while (!stack_.empty()) {
        const Photon photon = stack_.back();
        stack_.pop_back();
        follow(photon);
    }
}

void Walk::follow(Photon photon) {
    for (;;) {
        const Hit hit = body_.hit(photon.position, photon.direction, photon.triangle);
        const double flight = extinction_ > 0 ? -std::log(random_()) / extinction_ : endless;
        if (hit.triangle == no_triangle) {
            photon.position += photon.direction * flight;
            if (!(flight < endless) || body_.is_far_from(photon.position)) {
                tally_.lost += photon.weight;
                return;
            }
            if (!collide(photon)) return;
            continue;
        }
        const glm::dvec3& normal = body_.normal(hit.triangle);
        const double cosine = glm::dot(photon.direction, normal);
        const bool wall = cosine > 0 && photon.bodies == 1;
        const glm::dvec3 end = photon.position + photon.direction * hit.distance;
        const double reflected = wall ? inner_reflection(cosine) : 0.0;
        // What would leave if the photon were not stopped on the way: an expectation at every flight.
        if (wall)
            leave(hit.triangle, end,
                  photon.weight * std::exp(-extinction_ * hit.distance) * (1.0 - reflected));
        if (flight < hit.distance) {
            photon.position += photon.direction * flight;
            photon.triangle = no_triangle;
            if (!collide(photon)) return;
            continue;
        }
        photon.position = end;
        photon.triangle = hit.triangle;
        if (!wall) {
            photon.bodies += cosine > 0 ? -1 : 1;
            continue;
        }
        if (random_() >= reflected) return;
        photon.direction = medium_.rough ? cosine_direction(-normal, random_)
                                         : glm::normalize(photon.direction - normal * (2.0 * cosine));
    }
}

double Walk::inner_reflection(double cosine) const {
    if (medium_.refractive_index == 1.0) return 0.0;
    return medium_.rough ? inner_reflection_ : Fresnel(medium_.refractive_index, cosine).reflected;
}

void Walk::leave(std::uint32_t triangle, const glm::dvec3& point, double weight) {
    const glm::dvec3 share = body_.barycentric(triangle, point);
    const glm::uvec3& corners = body_.triangles()[triangle];
    for (int k = 0; k < 3; ++k) tally_.flux[corners[k]] += weight * share[k];
    tally_.left += weight;
}

/// Absorbs and scatters; then splits the photon or ends it by chance. False where it ends.
bool Walk::collide(Photon& photon) {
    const double albedo = medium_.scattering / extinction_;
    tally_.absorbed += photon.weight * (1.0 - albedo);
    photon.weight *= albedo;
    if (photon.weight <= 0) return false;
    photon.triangle = no_triangle;
    photon.direction = around(photon.direction, scattering_cosine(), random_());
    const double wanted = unit_weight_ * window_.weight_at(photon.position);
    if (photon.weight < 0.5 * wanted) {
        if (random_() * wanted >= photon.weight) return false;
        photon.weight = wanted;
    } else if (photon.weight > 2.0 * wanted) {
        constexpr int most = 50;
        const int parts = std::min(most, static_cast<int>(photon.weight / wanted));
        photon.weight /= parts;
        stack_.insert(stack_.end(), static_cast<std::size_t>(parts - 1), photon);
    }
    return true;
}

double Walk::scattering_cosine() {
    const double g = medium_.anisotropy;
    if (std::abs(g) < 1e-6) return 2.0 * random_() - 1.0;
    const double t = (1.0 - g * g) / (1.0 - g + 2.0 * g * random_());
    return std::clamp((1.0 + g * g - t * t) / (2.0 * g), -1.0, 1.0);
}

}  // namespace skinglow::testing
