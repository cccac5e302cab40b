#include <gtest/gtest.h>
#include <skinglow/rig.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <stdexcept>

#include "random_lights.h"
#include "rig/light_bounds.h"
#include "rounds.h"

using namespace skinglow;

namespace {

Box random_box(RandomScene& random) {
    const glm::dvec3 center = random.unit_vector() * random.decades(0.01, 30.0);
    const glm::dvec3 half = random.in_box(glm::dvec3(0.0), glm::dvec3(random.decades(0.001, 3.0)));
    return {center - half, center + half};
}

double largest(const glm::dvec3& v) {
    return std::max({v.r, v.g, v.b});
}

}  // namespace

TEST(LightBounds, HoldForEveryPointAndNormal) {
    RandomScene random(11);
    for (int trial = 0; trial < 3000; ++trial) {
        FlatLight light = random.light();
        light.power = 1;
        light.color = glm::dvec3(1.0);
        const Box box = random_box(random);
        if (random.one_in(10)) light.position = random.in_box(box.min, box.max);
        const IrradianceRange range = irradiance_range(PreparedLight(light), box);
        for (int i = 0; i < 8; ++i) {
            glm::dvec3 point = random.in_box(box.min, box.max);
            if (random.one_in(3))
                point = {random.one_in(2) ? box.min.x : box.max.x, random.one_in(2) ? box.min.y : box.max.y,
                         random.one_in(2) ? box.min.z : box.max.z};
            const double facing = object_irradiance({light}, point).r;
            EXPECT_LE(facing, range.max) << to_text(light.kind) << " " << trial;
            EXPECT_GE(facing, range.min) << to_text(light.kind) << " " << trial;
            EXPECT_LE(irradiance_at({light}, point, random.unit_vector()).r, range.max)
                << to_text(light.kind) << " " << trial;
        }
    }
}

TEST(LightBounds, HoldWhereALightStandsOnTheBox) {
    RandomScene random(18);
    int on_box = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        FlatLight light = random.light();
        light.power = 1;
        light.color = glm::dvec3(1.0);
        if (random.one_in(2)) {
            light.size_x = light.size_y = 1e-12;
            light.radius = 0.0;
        }
        const Box box = random_box(random);
        // A corner, or an edge, a face or the inside.
        for (int axis = 0; axis < 3; ++axis) {
            light.position[axis] = random.one_in(2) ? box.min[axis] : box.max[axis];
            if (random.one_in(6)) light.position[axis] = random.between(box.min[axis], box.max[axis]);
        }
        const glm::dvec3 near =
            glm::clamp(light.position + random.unit_vector() * random.decades(1e-9, 1e-3), box.min, box.max);
        const double max = irradiance_range(PreparedLight(light), box).max;
        const CullingResult result = PreparedRig({light}).cull(box, 1e300);
        for (const glm::dvec3& point : {light.position, near}) {
            const double facing = object_irradiance({light}, point).r;
            on_box += facing > 0.0 ? 1 : 0;
            EXPECT_LE(facing, max) << to_text(light.kind) << " " << trial;
            EXPECT_LE(facing, result.bound.r) << to_text(light.kind) << " " << trial;
        }
        // In a tree of two, whose node must hold the bound too.
        FlatLight other = light;
        other.position += light.direction;
        EXPECT_LE(object_irradiance({light, other}, light.position).r,
                  PreparedRig({light, other}).cull(box, 1e300).bound.r * (1 + 1e-12))
            << to_text(light.kind) << " " << trial;
    }
    EXPECT_GT(on_box, 2000);
}

TEST(LightBounds, ASpotOnTheCornerReachesIt) {
    // Shines away from the box; the corner itself is at its position, on its axis.
    FlatLight spot;
    spot.kind = LightKind::spot;
    spot.position = {1, 1, 1};
    spot.direction = {1, 1, 1};
    const Box box{glm::dvec3(0.0), glm::dvec3(1.0)};
    EXPECT_GT(object_irradiance({spot}, spot.position).r, 1e10);
    EXPECT_GE(PreparedRig({spot}).cull(box, 1e300).bound.r, object_irradiance({spot}, spot.position).r);
}

TEST(LightBounds, AreTightForSmallObjects) {
    RandomScene random(12);
    int tight = 0;
    int lit = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        FlatLight light = random.light();
        light.power = 1;
        light.color = glm::dvec3(1.0);
        light.radius = std::min(light.radius, 0.01);
        light.size_x = std::min(light.size_x, 0.01);
        light.size_y = std::min(light.size_y, 0.01);
        light.position = random.unit_vector() * random.between(1.0, 5.0);
        const double facing = object_irradiance({light}, glm::dvec3(0.0)).r;
        if (facing < 1e-6) continue;
        ++lit;
        const IrradianceRange range =
            irradiance_range(PreparedLight(light), {glm::dvec3(-1e-3), glm::dvec3(1e-3)});
        if (range.max < 1.1 * facing && range.min > 0.9 * facing) ++tight;
    }
    EXPECT_GT(lit, 300);
    EXPECT_GT(tight, 0.9 * lit);
}

TEST(LightBounds, ObjectWeightErrorHolds) {
    RandomScene random(13);
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<Light> lights = random.lights(6);
        const Box box = random_box(random);
        const glm::dvec3 center = box.center();
        const glm::dvec3 error = object_irradiance_error(lights, center, box);
        const glm::dvec3 here = object_irradiance(lights, center);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 there = object_irradiance(lights, random.in_box(box.min, box.max));
            EXPECT_LE(std::abs(there.g - here.g), error.g * (1 + 1e-12)) << trial;
        }
    }
}

TEST(LightCulling, BoundIsNeverExceeded) {
    RandomScene random(14);
    std::size_t dropped_in_all = 0;
    for (int trial = 0; trial < rounds(400); ++trial) {
        const std::vector<Light> lights = random.lights(1 + static_cast<int>(random.between(0, 120)));
        const Box box = random_box(random);
        const double tolerance = random.decades(1e-6, 10.0);
        const CullingResult result = PreparedRig(lights).cull(box, tolerance);
        EXPECT_LE(largest(result.bound), tolerance);

        std::set<std::size_t> seen(result.kept.begin(), result.kept.end());
        std::vector<Light> dropped;
        for (const DroppedLights& group : result.dropped) {
            for (const std::size_t index : group.lights) {
                EXPECT_TRUE(seen.insert(index).second) << "lamp " << index << " twice";
                dropped.push_back(lights[index]);
            }
        }
        EXPECT_EQ(seen.size(), lights.size());
        dropped_in_all += dropped.size();
        for (int i = 0; i < 4; ++i) {
            const glm::dvec3 point = random.in_box(box.min, box.max);
            const glm::dvec3 facing = object_irradiance(dropped, point);
            EXPECT_LE(largest(glm::abs(facing)), largest(result.bound) + 1e-15) << trial;
            const glm::dvec3 normal = random.unit_vector();
            glm::dvec3 surface(0.0);
            for (const Light& light : dropped) surface += irradiance_at({light}, point, normal);
            for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(surface[c]), result.bound[c] + 1e-15) << trial;
        }
    }
    EXPECT_GT(dropped_in_all, static_cast<std::size_t>(rounds(5000)));  // the property is not empty
}

TEST(LightCulling, WithoutToleranceOnlyWhatGivesNothingGoes) {
    RandomScene random(15);
    std::vector<Light> lights = random.lights(300);
    LightSettings hidden = lights[3].settings();
    hidden.visible = false;
    lights[3] = hidden;
    const Box box{glm::dvec3(-0.2), glm::dvec3(0.2)};
    const CullingResult result = PreparedRig(lights).cull(box, 0.0);
    EXPECT_EQ(result.bound, glm::dvec3(0.0));
    std::size_t unreachable = 0;
    for (const DroppedLights& group : result.dropped) {
        EXPECT_NE(group.reason, DropReason::negligible);
        if (group.reason == DropReason::off) {
            EXPECT_EQ(group.lights[0], 3U);
            for (std::size_t i = 1; i < group.lights.size(); ++i)
                EXPECT_EQ(std::get<AreaLight>(lights[group.lights[i]].shape()).size_y, 0.0);
        }
        if (group.reason != DropReason::unreachable) continue;
        for (const std::size_t index : group.lights) {
            ++unreachable;
            EXPECT_EQ(object_irradiance({lights[index]}, random.in_box(box.min, box.max)), glm::dvec3(0.0));
        }
    }
    EXPECT_GT(unreachable, 20U);
}

TEST(LightCulling, KeepsTheFewThatMatterOfManyThousands) {
    std::vector<FlatLight> lights(10000);
    RandomScene random(16);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        lights[i].position =
            random.unit_vector() * (i < 100 ? random.between(1.0, 2.0) : random.between(50.0, 100.0));
        lights[i].power = i < 100 ? 100 : 0.01;
    }
    const CullingResult result = PreparedRig(made(lights)).cull({glm::dvec3(-0.1), glm::dvec3(0.1)}, 0.01);
    ASSERT_EQ(result.kept.size(), 100U);
    for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(result.kept[i], i);
}

TEST(LightCulling, EdgeCases) {
    const Box box{glm::dvec3(0.0), glm::dvec3(0.0)};
    EXPECT_TRUE(PreparedRig().cull(box, 1.0).kept.empty());
    EXPECT_THROW(PreparedRig().cull(box, -1.0), std::invalid_argument);
    EXPECT_THROW(PreparedRig().cull({glm::dvec3(1.0), glm::dvec3(0.0)}, 1.0), std::invalid_argument);
    const std::vector<Light> one_position(10000);
    EXPECT_EQ(PreparedRig(one_position).cull(box, 1.0).kept.size(), 10000U);
    EXPECT_EQ(PreparedRig(one_position).cull({glm::dvec3(9.0), glm::dvec3(10.0)}, 1e6).kept.size(), 0U);
}

TEST(LightCulling, IdenticalLightsBecomeOne) {
    RandomScene random(17);
    std::vector<Light> lights;
    const FlatLight a = random.light();
    FlatLight b = random.light();
    b.position += glm::dvec3(0.1);
    for (int i = 0; i < 500; ++i) {
        FlatLight light = random.one_in(2) ? a : b;
        light.power = random.decades(0.1, 10.0) * (random.one_in(4) ? -1 : 1);
        light.color = random.in_box(glm::dvec3(0.0), glm::dvec3(1.0));
        lights.emplace_back(light);
    }
    const std::vector<Light> merged = merge_identical(lights);
    EXPECT_LE(merged.size(), 4U);
    const glm::dvec3 point(0.2, 0.1, -0.3);
    const glm::dvec3 all = object_irradiance(lights, point);
    const glm::dvec3 few = object_irradiance(merged, point);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(few[c], all[c], 1e-11 * (std::abs(all[c]) + 1));
}

TEST(LightCulling, MergesByWhatTheKindHas) {
    std::vector<FlatLight> suns(3);
    for (FlatLight& sun : suns) sun.kind = LightKind::sun;
    suns[1].position = {5, 5, 5};  // a sun has no position
    suns[1].spread = 1.0;          // nor a spread
    suns[2].sun_angle = 0.5;
    const std::vector<Light> merged = merge_identical(made(suns));
    ASSERT_EQ(merged.size(), 2U);
    EXPECT_EQ(merged[0].power(), 2.0);
    EXPECT_EQ(std::get<SunLight>(merged[1].shape()).sun_angle, 0.5);

    std::vector<FlatLight> points(4);
    points[1].direction = {1, 0, 0};  // a point shines to all sides
    points[2].radius = 0.1;
    points[3].soft_falloff = false;
    EXPECT_EQ(merge_identical(made(points)).size(), 3U);

    std::vector<FlatLight> areas(4);
    for (FlatLight& area : areas) area.kind = LightKind::area;
    areas[1].area_shape = AreaShape::ellipse;
    areas[2].tangent = {0, 1, 0};
    areas[3].direction *= 3.0;  // no direction has a length
    areas[3].tangent *= 0.5;
    EXPECT_EQ(merge_identical(made(areas)).size(), 3U);
}
