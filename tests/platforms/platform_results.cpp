#include <skinglow/lut.h>
#include <skinglow/occlusion.h>
#include <skinglow/rig.h>
#include <skinglow/shape.h>
#include <skinglow/slab.h>
#include <skinglow/thickness.h>
#include <skinglow/tissue.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <vector>

#include "core/flat_light.h"
#include "core/mesh_shapes.h"
#include "rays/embree_triangles.h"

/// Prints what this processor computes of each part of the library: a line for each, its name and its numbers. No random numbers:
/// C++ libraries differ in their distributions.
namespace {

using namespace skinglow;

void print(const char* name, std::span<const double> values) {
    std::printf("%s", name);
    for (const double value : values) std::printf(" %.17g", value);
    std::printf("\n");
}

void print(const char* name, std::span<const glm::dvec3> values) {
    std::vector<double> flat;
    for (const glm::dvec3& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
    print(name, flat);
}

/// One of each kind, soft, about a body of size 1 at the origin.
std::vector<Light> lights() {
    FlatLight point{.color = {1.0, 0.5, 0.2}, .position = {0.5, 0.4, 3.0}, .power = 30.0, .radius = 0.2};
    FlatLight spot{
        .kind = LightKind::spot, .color = {0.2, 0.4, 1.0}, .position = {-3.0, 1.0, 0.5}, .power = 80.0};
    spot.direction = -spot.position;
    spot.spot_angle = 1.2;
    FlatLight sun{.kind = LightKind::sun, .direction = {0.3, -0.8, -0.6}, .power = 2.0, .sun_angle = 0.1};
    FlatLight area{
        .kind = LightKind::area, .position = {0.3, -2.5, -1.0}, .power = 50.0, .size_x = 1.5, .size_y = 0.7};
    area.direction = -area.position;
    area.tangent = {0.2, 1.0, 0.4};
    area.spread = 2.0;
    return made({point, spot, sun, area});
}

std::vector<glm::dvec3> unit(std::span<const glm::dvec3> points) {
    std::vector<glm::dvec3> result;
    for (const glm::dvec3& p : points) result.push_back(glm::normalize(p));
    return result;
}

void print_optics() {
    const std::vector<Layer> layers = {{1.4, 0.5, 20.0, 0.8, 0.1}, {1.4, 0.05, 15.0, 0.8, 3.0}};
    const SlabResult solved = slab(layers, Incidence::diffuse());
    print("slab",
          std::vector{solved.reflectance, solved.transmittance, solved.unscattered, solved.absorbed[1]});
    std::vector<double> table;
    const BaseLut base = base_lut(tissue_preset("light").tissue, 64);
    for (const glm::dmat3& matrix : base.matrices()) {
        for (int k = 0; k < 3; ++k) table.insert(table.end(), {matrix[k].x, matrix[k].y, matrix[k].z});
    }
    print("base_lut", table);
}

/// 50,000 rays from within and around an uneven body: for each the nearest triangle, -1 for none, and its distance.
void print_hits() {
    shapes::Mesh body = shapes::shell(1.0, 0.2, 5);
    for (glm::dvec3& v : body.vertices)
        v *= 1.0 + 0.1 * std::sin(5.0 * v.x + 3.0 * v.y) * std::cos(4.0 * v.z);
    const detail::EmbreeTriangles triangles(body.vertices, body.triangles);
    constexpr int count = 50'000;
    std::vector<double> found;
    std::vector<double> distances;
    for (int i = 0; i < count; ++i) {
        // Points on a spiral about a sphere, each in a direction of another such spiral.
        const auto spiral = [](double z, double turn) {
            const double across = std::sqrt(1.0 - z * z);
            return glm::dvec3(across * std::cos(turn), across * std::sin(turn), z);
        };
        const double t = (i + 0.5) / count;
        const glm::dvec3 origin =
            (0.1 + 1.9 * std::fmod(t * 997.0, 1.0)) * spiral(1.0 - 2.0 * t, 2.39996 * i);
        const glm::dvec3 direction = spiral(2.0 * std::fmod(t * 7919.0, 1.0) - 1.0, 1.7 * i);
        const auto hit = triangles.nearest(origin, direction, 0.0F);
        found.push_back(hit ? hit->triangle : -1.0);
        distances.push_back(hit ? hit->distance : 0.0);
    }
    print("hits", found);
    print("hit_distances", distances);
}

void print_light_and_rays() {
    const PreparedRig rig(lights());
    const shapes::Mesh ball = shapes::sphere(0.5, 4);
    const std::vector<glm::dvec3> normals = unit(ball.vertices);
    print("irradiance", surface_irradiance(rig, ball.vertices, normals));

    shapes::Mesh uneven = shapes::shell(1.0, 0.1, 4);
    for (glm::dvec3& v : uneven.vertices) v *= 1.0 + 0.05 * std::sin(7.0 * v.x) * std::cos(5.0 * v.y);
    print("thickness", thickness(uneven.view(), {.unit_mm = 10.0}));

    shapes::Mesh wall = shapes::box({0.6, 0.6, 0.1}, 2);
    for (glm::dvec3& v : wall.vertices) v += glm::dvec3(-0.2, -0.1, 1.0);
    const std::vector<MeshView> meshes = {ball.view(), wall.view()};
    const VisibleFraction visible =
        visible_fraction(Occluders(meshes), rig, ball.vertices, normals, {.samples = 64, .excluded = {0}});
    print("visible", visible.at_points);
}

void print_shape() {
    shapes::Mesh lobe = shapes::sphere(1.0, 4);
    for (glm::dvec3& v : lobe.vertices) v *= glm::dvec3(6.0, 4.0, 2.0 + 0.3 * std::sin(3.0 * v.x));
    const Shape shape(lobe.view(), tissue_preset("light").tissue, {.cell_mm = 0.5});
    FlatLight behind{.position = {2.0, 1.0, -12.0}, .power = 1000.0, .radius = 0.5};
    FlatLight beside{.position = {15.0, -3.0, 2.0}, .power = 700.0};
    const LitShape lit = shape.light(made({behind, beside}));
    print("shape_exitance", lit.exitance());
    print("shape_transmitted", lit.transmitted());
    print("shape_irradiance", lit.irradiance());
}

}  // namespace

int main() {
    print_optics();
    print_hits();
    print_light_and_rays();
    print_shape();
}
