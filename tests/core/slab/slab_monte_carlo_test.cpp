// The slab solver against photons, where no closed form exists: layers with indices and coefficients of their
// own.
#include <gtest/gtest.h>
#include <skinglow/slab.h>

#include <cmath>
#include <string>
#include <vector>

#include "monte_carlo.h"

namespace skinglow {
namespace {

using testing::Estimate;

struct Case {
    std::string name;
    std::vector<Layer> layers;
    Incidence incidence;
    double n_above = 1;
    double n_below = 1;
};

const std::vector<Case>& cases() {
    static const std::vector<Case> list{
        {"one_layer_normal", {{1.4, 0.1, 5, 0.8, 1}}, Incidence::normal()},
        {"one_layer_diffuse", {{1.4, 0.1, 5, 0.8, 1}}, Incidence::diffuse()},
        {"backward_peak_oblique", {{1.3, 0.2, 1, -0.7, 1}}, Incidence::oblique(0.3)},
        {"index_rises_and_falls",
         {{1.33, 0.1, 2, 0.5, 0.5}, {1.5, 0.05, 4, 0.8, 0.5}, {1.38, 0.3, 1, 0.0, 0.5}},
         Incidence::diffuse()},
        {"index_rises_and_falls_normal",
         {{1.33, 0.1, 2, 0.5, 0.5}, {1.5, 0.05, 4, 0.8, 0.5}, {1.38, 0.3, 1, 0.0, 0.5}},
         Incidence::normal()},
        {"from_glass_into_water", {{1.45, 0.1, 3, 0.7, 0.8}}, Incidence::diffuse(), 1.5, 1.33},
        {"denser_outside_oblique", {{1.1, 0.1, 1, 0.3, 0.8}}, Incidence::oblique(0.8), 1.5, 1.2},
        {"grazing_beam_that_gains_by_scattering", {{1.6, 1e-4, 60, 0.66, 0.02}}, Incidence::oblique(0.0136)},
        {"light_behind_a_dense_sheet",
         {{1, 0, 3, 0.54, 1}, {1.4, 0, 5, -0.8, 0.5}, {1.33, 0, 3, -0.26, 1}},
         Incidence::normal()},
        {"clear_gap",
         {{1.4, 0.1, 3, 0.7, 0.4}, {1.0, 0, 0, 0, 1}, {1.4, 0.2, 3, 0.7, 0.4}},
         Incidence::diffuse()},
        {"ear_three_layers",
         {{1.4, 2, 40, 0.75, 0.06}, {1.4, 0.1, 15, 0.715, 1.5}, {1.4, 2, 40, 0.75, 0.06}},
         Incidence::diffuse()},
        {"half_space", {{1.4, 1, 5, 0.8, 0.3}, {1.37, 0.5, 5, 0.6, INFINITY}}, Incidence::normal()},
    };
    return list;
}

class MonteCarloTest : public ::testing::TestWithParam<Case> {};

TEST(MonteCarlo, confirms_that_a_grazing_beam_gains_by_scattering) {
    Layer plate{1.6, 0, 60, 0.66, 0.02};
    const double scattering = slab({&plate, 1}, Incidence::oblique(0.0136), 1, 1, 32).transmittance;
    plate.thickness = 0;
    EXPECT_GT(scattering, 1.05 * slab({&plate, 1}, Incidence::oblique(0.0136), 1, 1, 32).transmittance);
}

TEST_P(MonteCarloTest, agrees_within_four_and_a_half_standard_errors) {
    const Case& c = GetParam();
    const auto photons =
        testing::monte_carlo_slab(c.layers, c.incidence, c.n_above, c.n_below, 100000, 20240);
    const SlabResult solved = slab(c.layers, c.incidence, c.n_above, c.n_below, 32);
    const auto near = [](double value, const Estimate& estimate, const std::string& what) {
        EXPECT_LE(std::abs(value - estimate.mean), 4.5 * estimate.error + 1e-6)
            << what << ": " << value << " against " << estimate.mean << " +- " << estimate.error;
        EXPECT_LT(estimate.error, 2e-3) << what << ": too noisy to tell anything";
    };
    near(solved.reflectance, photons.reflectance, "reflectance");
    near(solved.transmittance, photons.transmittance, "transmittance");
    near(solved.unscattered, photons.unscattered, "unscattered");
    for (std::size_t i = 0; i < solved.absorbed.size(); ++i) {
        near(solved.absorbed[i], photons.absorbed[i], "absorbed in layer " + std::to_string(i));
    }
}

INSTANTIATE_TEST_SUITE_P(layers, MonteCarloTest, ::testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace skinglow
