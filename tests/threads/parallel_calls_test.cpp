// Everything that runs on several threads: the same on any number, stopped in the middle, and from two threads at once.

#include <gtest/gtest.h>
#include <skinglow/face_tiles.h>
#include <skinglow/lut.h>
#include <skinglow/occlusion.h>
#include <skinglow/rig.h>
#include <skinglow/shape.h>
#include <skinglow/thickness.h>
#include <skinglow/tissue.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "mesh_shapes.h"

namespace skinglow::test {
namespace {

using Numbers = std::vector<double>;
using Progress = std::function<bool(double)>;
using Call = std::function<Numbers(int threads)>;
using LongCall = std::function<Numbers(int threads, const Progress& progress)>;

Numbers numbers_of(const std::vector<glm::dvec3>& vectors) {
    Numbers numbers;
    for (const glm::dvec3& v : vectors) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
}

const shapes::Mesh& lobe() {
    static const shapes::Mesh mesh = [] {
        shapes::Mesh flat = shapes::sphere(1.0, 3);
        for (glm::dvec3& v : flat.vertices) v *= glm::dvec3(6.0, 5.0, 1.5);
        return flat;
    }();
    return mesh;
}

const std::vector<glm::dvec3>& up() {
    static const std::vector<glm::dvec3> normals(lobe().vertices.size(), glm::dvec3(0, 0, 1));
    return normals;
}

PreparedRig lights() {
    LightSettings bulb;
    bulb.position = {0.0, 5.0, 60.0};
    bulb.color = {1.0, 0.5, 0.2};
    bulb.power = 1000.0;
    bulb.shape = PointLight{3.0, true};
    LightSettings panel = bulb;
    panel.direction = {0.0, 0.0, -1.0};
    AreaLight area;
    area.size_x = 5.0;
    area.size_y = 4.0;
    area.spread = 2.0;
    panel.shape = area;
    return PreparedRig(std::vector<Light>{bulb, panel});
}

Shape shape(int threads, const Progress& progress = {}) {
    ShapeOptions options;
    options.cell_mm = 1.2;
    options.threads = threads;
    return {lobe().view(), Tissue(), options, {}, progress};
}

const std::vector<glm::dvec3>& ramp() {
    static const std::vector<glm::dvec3> irradiance = [] {
        std::vector<glm::dvec3> values;
        for (std::size_t i = 0; i < lobe().vertices.size(); ++i) values.emplace_back(static_cast<double>(i));
        return values;
    }();
    return irradiance;
}

LitShape lit(int threads, const Progress& progress = {}) {
    ShapeLightOptions options;
    options.reentries = 1;
    options.shadow_samples = 2;
    return shape(threads).light(lights(), options, progress);
}

const Occluders& occluders() {
    static const Occluders scene = [] {
        const std::array meshes{lobe().view()};
        return Occluders(meshes);
    }();
    return scene;
}

/// More texels than one block, so that several threads fill them.
Numbers tiles() {
    const shapes::Mesh& mesh = lobe();
    const std::vector<std::uint32_t> sizes(mesh.triangles.size(), 3);
    std::vector<std::uint32_t> corners;
    for (const glm::uvec3& t : mesh.triangles) corners.insert(corners.end(), {t.x, t.y, t.z});
    FaceTilesOptions options;
    options.spacing_mm = 0.03;
    const FaceTiles layout(mesh.vertices, sizes, corners, {}, options);
    EXPECT_GT(layout.height() * tile_image_width, std::size_t{1} << 17U);
    const TileTargets targets(mesh.view(), layout.texels(), layout.height());
    std::vector<float> pixels(layout.height() * tile_image_width);
    std::vector<double> values(targets.points().size());
    std::iota(values.begin(), values.end(), 0.0);
    targets.spread(values, 1, 1, pixels);
    return {pixels.begin(), pixels.end()};
}

const std::map<std::string, LongCall>& long_calls() {
    static const std::map<std::string, LongCall> calls{
        {"thickness",
         [](int threads, const Progress& progress) {
             ThicknessOptions options;
             options.rays = 256;
             options.min_sky_visibility = 0.05;
             options.threads = threads;
             return thickness(lobe().view(), options, progress);
         }},
        {"Shape",
         [](int threads, const Progress& progress) {
             Numbers centers;
             for (const ShapePart& part : shape(threads, progress).parts()) centers.push_back(part.center.x);
             return centers;
         }},
        {"exitance",
         [](int threads, const Progress& progress) {
             return numbers_of(shape(threads).exitance(ramp(), progress));
         }},
        {"error",
         [](int threads, const Progress& progress) {
             return numbers_of(shape(threads).exitance_error(ramp(), progress));
         }},
        {"light",
         [](int threads, const Progress& progress) { return numbers_of(lit(threads, progress).exitance()); }},
        {"per light",
         [](int threads, const Progress& progress) { return numbers_of(lit(threads).per_light(progress)); }}};
    return calls;
}

std::map<std::string, Call> all_calls() {
    std::map<std::string, Call> calls{
        {"surface irradiance",
         [](int threads) {
             SurfaceOptions options;
             options.threads = threads;
             return numbers_of(surface_irradiance(lights(), lobe().vertices, up(), options));
         }},
        {"visible fraction",
         [](int threads) {
             VisibilityOptions options;
             options.threads = threads;
             return visible_fraction(occluders(), lights(), lobe().vertices, up(), options).at_points;
         }},
        {"transmittance",
         [](int threads) {
             const std::vector<double> mm{0.5, 2.0}, nm{450, 500, 520, 550, 580, 600, 620, 650, 680, 700};
             return transmittance(Tissue(), mm, nm, Incidence::diffuse(), 8, threads);
         }},
        {"base table", [](int threads) {
             const BaseLut table = base_lut(Tissue(), 8, 12.0, 0.01, threads);
             Numbers numbers;
             for (const glm::dmat3& m : table.matrices())
                 for (int k = 0; k < 3; ++k) numbers.insert(numbers.end(), {m[k].x, m[k].y, m[k].z});
             return numbers;
         }}};
    for (const auto& [name, call] : long_calls())
        calls[name] = [call = call](int threads) { return call(threads, {}); };
    return calls;
}

TEST(ParallelCalls, AreTheSameOnAnyNumberOfThreads) {
    for (const auto& [name, call] : all_calls()) {
        const Numbers expected = call(1);
        EXPECT_FALSE(expected.empty()) << name;
        for (const int threads : {2, 8}) EXPECT_EQ(call(threads), expected) << name << " on " << threads;
    }
}

TEST(ParallelCalls, StopWhereProgressAsksForItAndWorkAgain) {
    struct Stop {};
    for (const auto& [name, call] : long_calls()) {
        for (const int threads : {1, 8}) {
            const Numbers expected = call(threads, {});
            EXPECT_THROW(call(threads, [](double) -> bool { throw Stop{}; }), Stop) << name;
            EXPECT_THROW(call(threads, [](double) { return false; }), std::runtime_error) << name;
            int told = 0;
            try {  // in the middle, if it is not through by then
                call(threads, [&](double) { return ++told < 3; });
            } catch (const std::runtime_error&) {
                EXPECT_EQ(told, 3) << name;
            }
            EXPECT_EQ(call(threads, {}), expected) << name;
        }
    }
}

TEST(ParallelCalls, FromTwoThreadsAtOnceEachHaveTheirOwnAnswer) {
    const Shape one_shape = shape(0);
    const LitShape one_light = lit(0);
    auto calls = all_calls();
    calls["tiles"] = [](int) { return tiles(); };
    calls["one shape"] = [&](int) { return numbers_of(one_shape.exitance(ramp())); };
    calls["one shape, lit"] = [&](int) { return numbers_of(one_shape.light(lights()).exitance()); };
    calls["one light, recolored"] = [&](int) {
        const std::array colors{glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)};
        return numbers_of(one_light.recolor(colors));
    };
    std::map<std::string, Numbers> expected;
    for (const auto& [name, call] : all_calls()) expected[name] = call(2);
    std::array<std::map<std::string, Numbers>, 2> found;
    {
        const std::jthread forward([&] {
            for (const auto& [name, call] : calls) found[0][name] = call(2);
        });
        const std::jthread backward([&] {
            // Not std::views::reverse, which clang before 16 cannot read in this standard library.
            std::for_each(calls.rbegin(), calls.rend(),
                          [&](const auto& each) { found[1][each.first] = each.second(2); });
        });
    }
    EXPECT_EQ(found[0], found[1]);
    for (const auto& [name, numbers] : expected) EXPECT_EQ(found[0][name], numbers) << name;
}

TEST(ParallelCalls, OfTheSameBodyMayBeStoppedByOneThreadWhileAnotherGoesOn) {
    const Shape one_shape = shape(2);
    std::vector<glm::dvec3> found;
    {
        const std::jthread other([&] { found = one_shape.exitance(ramp()); });
        EXPECT_THROW(one_shape.exitance(ramp(), [](double) { return false; }), ShapeCancelled);
    }
    EXPECT_EQ(found, shape(1).exitance(ramp()));
}

}  // namespace
}  // namespace skinglow::test
