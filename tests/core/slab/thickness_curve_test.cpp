#include <gtest/gtest.h>
#include <skinglow/slab.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace skinglow {
namespace {

struct Stack {
    std::string name;
    std::vector<Layer> layers;
    std::size_t variable;
    double n_above = 1;
    double n_below = 1;
};

const std::vector<Stack>& stacks() {
    static const Layer epidermis{1.4, .5, 20, .75, .1};
    static const Layer dermis{1.4, .05, 20, .8, 1};
    static const std::vector<Stack> list{
        {"one_layer", {dermis}, 0},
        {"one_layer_in_unlike_media", {dermis}, 0, 1, 1.33},
        {"epidermis_on_both_sides", {epidermis, dermis, epidermis}, 1},
        {"epidermis_on_one_side", {epidermis, dermis}, 1},
        {"other_index_within", {epidermis, {1.33, .01, 5, .9, 1}, epidermis}, 1},
        {"no_absorption", {{1.4, 0, 20, .8, 1}}, 0},
        {"no_scattering", {epidermis, {1.4, .3, 0, 0, 1}, epidermis}, 1},
        {"nothing_in_it", {epidermis, {1.4, 0, 0, 0, 1}, epidermis}, 1},
    };
    return list;
}

class ThicknessCurveTest : public ::testing::TestWithParam<Stack> {};

TEST_P(ThicknessCurveTest, is_the_slab_solver_for_every_thickness) {
    const Stack& stack = GetParam();
    for (const Incidence incidence : {Incidence::normal(), Incidence::diffuse(), Incidence::oblique(.4)}) {
        const ThicknessCurve curve(stack.layers, stack.variable, incidence, stack.n_above, stack.n_below, 8);
        // Not in order, and more than one set of lanes.
        const std::vector<double> thickness{3, 0, 1e-9, .02, .3, 12, 1e-3, 1, 60, .05, 200, 1e-6};
        std::vector<double> out(thickness.size());
        curve.transmittance(thickness, out);
        for (std::size_t i = 0; i < thickness.size(); ++i) {
            std::vector<Layer> layers = stack.layers;
            layers[stack.variable].thickness = thickness[i];
            const double expected = slab(layers, incidence, stack.n_above, stack.n_below, 8).transmittance;
            EXPECT_NEAR(out[i] / expected, 1, 1e-11) << thickness[i] << " mm";
            EXPECT_NEAR(curve.transmittance(thickness[i]) / out[i], 1, 1e-13) << thickness[i] << " mm";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(stacks, ThicknessCurveTest, ::testing::ValuesIn(stacks()),
                         [](const auto& test) { return test.param.name; });

// For isotropic scattering the diffusion exponent solves a atanh(k) / k = 1 (Case and Zweifel 1967, 4.3).
TEST(ThicknessCurve, decays_in_the_end_at_the_diffusion_exponent) {
    for (const double albedo : {.9, .99, .999, 1 - 1e-6, 1 - 1e-9}) {
        double low = 0;
        double high = 1;
        for (int i = 0; i < 200; ++i) {
            const double k = .5 * (low + high);
            // atanh(k) / k - 1 as a series where k is small: there the difference would be rounding alone.
            const double excess =
                k < .01 ? k * k / 3 + k * k * k * k / 5 + std::pow(k, 6) / 7 : std::atanh(k) / k - 1;
            (excess < (1 - albedo) / albedo ? low : high) = k;
        }
        const Layer layer{1.4, 1 - albedo, albedo, 0, 0};
        const ThicknessCurve curve({&layer, 1}, 0, Incidence::diffuse(), 1, 1, 32);
        EXPECT_NEAR(curve.decay_rate() / low, 1, 1e-9) << albedo;
        const double d = 30 / low;
        EXPECT_NEAR(std::log(curve.transmittance(d) / curve.transmittance(2 * d)) / (low * d), 1, 1e-9)
            << albedo;
    }
}

TEST(ThicknessCurve, keeps_its_digits_down_to_1e_minus_60) {
    const Layer layer{1.4, .2, 5, .7, 0};
    for (const int streams : {8, 16}) {
        const ThicknessCurve curve({&layer, 1}, 0, Incidence::diffuse(), 1, 1, streams);
        const double k = curve.decay_rate();
        const double reference = curve.transmittance(20 / k);
        for (const double decades : {30.0, 60.0, 100.0, 200.0}) {
            const double d = (20 + decades * std::log(10.0)) / k;
            EXPECT_NEAR(curve.transmittance(d) / (reference * std::pow(10, -decades)), 1, 1e-9) << decades;
        }
    }
}

TEST(ThicknessCurve, falls_steadily) {
    for (const Stack& stack : stacks()) {
        SCOPED_TRACE(stack.name);
        const ThicknessCurve curve(stack.layers, stack.variable, Incidence::diffuse(), stack.n_above,
                                   stack.n_below, 8);
        std::vector<double> thickness;
        for (int i = 0; i < 1000; ++i) thickness.push_back(12.0 * i / 999);
        std::vector<double> out(thickness.size());
        curve.transmittance(thickness, out);
        const bool empty = stack.name == "nothing_in_it";
        for (std::size_t i = 1; i < out.size(); ++i) {
            if (empty)
                EXPECT_NEAR(out[i] / out[0], 1, 1e-12);
            else
                EXPECT_LT(out[i], out[i - 1]) << thickness[i] << " mm";
        }
    }
}

TEST(ThicknessCurve, refuses_bad_arguments) {
    const Layer layer{1.4, .1, 1, .5, 1};
    EXPECT_THROW(ThicknessCurve({&layer, 1}, 1, Incidence::normal()), std::invalid_argument);
    EXPECT_THROW(ThicknessCurve({}, 0, Incidence::normal()), std::invalid_argument);
    EXPECT_THROW(ThicknessCurve({&layer, 1}, 0, Incidence::normal(), 1, 1, 9), std::invalid_argument);
    const std::vector<Layer> ends{layer, {1.4, .1, 1, .5, INFINITY}};
    EXPECT_THROW(ThicknessCurve(ends, 0, Incidence::normal()), std::invalid_argument);
    const ThicknessCurve curve({&layer, 1}, 0, Incidence::normal());
    for (const double d : {-1.0, std::nan(""), static_cast<double>(INFINITY)}) {
        EXPECT_THROW(static_cast<void>(curve.transmittance(d)), std::invalid_argument) << d;
    }
    std::vector<double> out(2);
    EXPECT_THROW(curve.transmittance(std::vector<double>{1}, out), std::invalid_argument);
}

}  // namespace
}  // namespace skinglow
