#include "files/image_compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "test_image.h"

namespace skinglow::test {
namespace {

TEST(ImageCompare, HandComputedNumbers) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {2, 1, {"R", "G", "B"}, {0.5F, 0.5F, 0.5F, 0.0F, 0.0F, 0.0F}});
    write_test_image(folder / "b.exr", {2, 1, {"R", "G", "B"}, {0.5F, 0.25F, 0.5F, 0.0F, 0.5F, 2.0F}});
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr");
    EXPECT_EQ(result.channel[0].rms, 0.0);
    EXPECT_FALSE(result.channel[0].psnr.has_value()) << "no bound where nothing differs";
    EXPECT_DOUBLE_EQ(result.channel[1].rms, std::sqrt((0.0625 + 0.25) / 2.0));
    EXPECT_DOUBLE_EQ(result.channel[2].rms, std::sqrt(4.0 / 2.0));
    EXPECT_DOUBLE_EQ(result.total.rms, std::sqrt((0.0625 + 0.25 + 4.0) / 6.0));
    EXPECT_EQ(result.total.max, 2.0);
    EXPECT_DOUBLE_EQ(*result.total.psnr, -20.0 * std::log10(std::sqrt(4.3125 / 6.0)));
    EXPECT_EQ(result.worst_x, 1U);
    EXPECT_EQ(result.worst_y, 0U);
    EXPECT_EQ(result.compared_pixels, 2U);
    EXPECT_EQ(result.error, (std::vector<float>{0.25F, 2.0F}));
    CompareOptions bright;
    bright.peak = 10.0;
    EXPECT_NEAR(*compare_images(folder / "a.exr", folder / "b.exr", bright).total.psnr,
                *result.total.psnr + 20.0, 1e-12);
}

TEST(ImageCompare, AnImageIsItself) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {1, 1, {"R", "G", "B"}, {1e38F, -3e38F, 0.0F}});
    write_test_image(folder / "b.exr", {1, 1, {"R", "G", "B"}, {1e38F, 3e38F, 0.0F}});
    const ImageComparison same = compare_images(folder / "a.exr", folder / "a.exr");
    EXPECT_EQ(same.total.rms, 0.0);
    EXPECT_FALSE(same.total.psnr.has_value());
    const ImageComparison far = compare_images(folder / "a.exr", folder / "b.exr");
    EXPECT_TRUE(std::isfinite(far.total.rms) && std::isfinite(far.total.max) && std::isfinite(far.error[0]));
}

TEST(ImageCompare, PercentilesAreOfTheComparedPixels) {
    const ScratchFolder folder;
    std::vector<float> first(3000, 0.0F);
    std::vector<float> second(3000);
    for (std::size_t i = 0; i < 1000; ++i) second[3 * i + i % 3] = static_cast<float>(i + 1) / 1024.0F;
    write_test_image(folder / "a.exr", {1000, 1, {"R", "G", "B"}, first});
    write_test_image(folder / "b.exr", {1000, 1, {"R", "G", "B"}, second});
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr");
    const std::vector<std::pair<double, double>> expected = {
        {50, 500.0 / 1024}, {90, 900.0 / 1024}, {95, 950.0 / 1024}, {99, 990.0 / 1024}, {99.9, 999.0 / 1024}};
    EXPECT_EQ(result.percentiles, expected);
}

TEST(ImageCompare, SideBySideShowsBothAndTheHeatMap) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {2, 1, {"R", "G", "B"}, {0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F}});
    write_test_image(folder / "b.exr", {2, 1, {"R", "G", "B"}, {0.0F, 0.0F, 0.0F, 0.0F, 9.0F, 0.0F}});
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr");
    EXPECT_EQ(heat_map_white(result), 8.0);
    write_side_by_side(folder / "s.png", folder / "a.exr", folder / "b.exr", result, 8.0);
    const LinearImage shown = read_image(folder / "s.png");
    EXPECT_EQ(shown.width, 6);
    EXPECT_EQ(shown.height, 1);
    const std::vector<float> expected = {0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1};
    EXPECT_EQ(shown.rgb, expected);
    expect_refused<FileError>(
        [&] { write_side_by_side(folder / "s.jpg", folder / "a.exr", folder / "b.exr", result, 8.0); },
        {".png"});
}

TEST(ImageCompare, MaskLeavesOut) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {2, 1, {"R", "G", "B"}, std::vector<float>(6, 0.0F)});
    write_test_image(folder / "b.exr", {2, 1, {"R", "G", "B"}, {0.5F, 0.5F, 0.5F, 9.0F, 9.0F, 9.0F}});
    write_test_image(folder / "m.png", {2, 1, {"Y"}, {1.0F, 0.0F}, OIIO::TypeUInt8});
    CompareOptions options;
    options.mask = folder / "m.png";
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr", options);
    EXPECT_EQ(result.total.rms, 0.5);
    EXPECT_EQ(result.compared_pixels, 1U);
    EXPECT_EQ(result.left_out_pixels, 1U);
    EXPECT_EQ(result.error[1], -1.0F);
    write_test_image(folder / "m.png", {2, 1, {"Y"}, {0.0F, 0.0F}, OIIO::TypeUInt8});
    expect_refused<FileError>([&] { compare_images(folder / "a.exr", folder / "b.exr", options); },
                              {"no pixel left"});
}

/// 7 x 1, a silhouette between columns 2 and 3; the two differ there by much and within by little.
std::vector<float> silhouette(float edge_alpha, float inside) {
    std::vector<float> values;
    for (int x = 0; x < 7; ++x) {
        const float alpha = x < 2 ? 0.0F : (x == 2 ? edge_alpha : 1.0F);
        values.insert(values.end(), {alpha * inside, alpha * inside, alpha * inside, alpha});
    }
    return values;
}

TEST(ImageCompare, EdgesOfTheAlphaAreLeftOut) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {7, 1, {"R", "G", "B", "A"}, silhouette(0.25F, 0.5F)});
    write_test_image(folder / "b.exr", {7, 1, {"R", "G", "B", "A"}, silhouette(0.75F, 0.5625F)});
    EXPECT_GT(compare_images(folder / "a.exr", folder / "b.exr").total.max, 0.25);
    CompareOptions options;
    options.ignore_edges = true;
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr", options);
    EXPECT_EQ(result.left_out_pixels, 3U) << "columns 1, 2 and 3 see more than one alpha";
    EXPECT_EQ(result.total.max, 0.0625);
    EXPECT_EQ(result.error[2], -1.0F);
    EXPECT_EQ(result.error[4], 0.0625F);
}

TEST(ImageCompare, EdgesOfEitherImageAndOfTheMaskCount) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {7, 1, {"R", "G", "B"}, std::vector<float>(21, 0.5F)});
    write_test_image(folder / "b.exr", {7, 1, {"R", "G", "B", "A"}, silhouette(0.5F, 0.5F)});
    CompareOptions options;
    options.ignore_edges = true;
    EXPECT_EQ(compare_images(folder / "a.exr", folder / "b.exr", options).left_out_pixels, 3U);
    expect_refused<FileError>([&] { compare_images(folder / "a.exr", folder / "a.exr", options); },
                              {"no alpha", "mask"});
    write_test_image(folder / "ids.exr", {7, 1, {"Y"}, {1, 1, 1, 1, 1, 2, 2}});
    options.mask = folder / "ids.exr";
    EXPECT_EQ(compare_images(folder / "a.exr", folder / "a.exr", options).left_out_pixels, 2U)
        << "where objects meet";
}

TEST(ImageCompare, BackgroundIsLeftOut) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {7, 1, {"R", "G", "B", "A"}, silhouette(0.0F, 0.5F)});
    write_test_image(folder / "b.exr", {7, 1, {"R", "G", "B", "A"}, silhouette(1.0F, 0.5F)});
    CompareOptions options;
    options.ignore_background = true;
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr", options);
    EXPECT_EQ(result.compared_pixels, 5U) << "column 2 is covered by one of them";
    EXPECT_EQ(result.left_out_pixels, 2U);
    EXPECT_EQ(result.background_pixels, 2U);
    options.ignore_edges = true;
    const ImageComparison both = compare_images(folder / "a.exr", folder / "b.exr", options);
    EXPECT_EQ(both.compared_pixels, 3U) << "columns 4, 5 and 6";
    EXPECT_EQ(both.background_pixels, 2U) << "columns 0 and 1, which is next to an edge too";
    EXPECT_NEAR(result.total.rms, 0.5 / std::sqrt(5.0), 1e-12);
    write_test_image(folder / "c.exr", {7, 1, {"R", "G", "B"}, std::vector<float>(21, 0.5F)});
    expect_refused<FileError>([&] { compare_images(folder / "c.exr", folder / "c.exr", options); },
                              {"no alpha", "transparent"});
}

TEST(ImageCompare, RefusesUnlikeSizesNamingBoth) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {2, 1, {"Y"}, {1, 2}});
    write_test_image(folder / "b.exr", {1, 3, {"Y"}, {1, 2, 3}});
    expect_refused<FileError>([&] { compare_images(folder / "a.exr", folder / "b.exr"); },
                              {"a.exr", "2 x 1", "b.exr", "1 x 3"});
    CompareOptions options;
    options.mask = folder / "b.exr";
    expect_refused<FileError>([&] { compare_images(folder / "a.exr", folder / "a.exr", options); },
                              {"1 x 3", "2 x 1"});
    options = {};
    options.peak = 0.0;
    expect_refused<std::invalid_argument>(
        [&] { compare_images(folder / "a.exr", folder / "a.exr", options); }, {"peak"});
}

TEST(HeatMap, BrightnessRisesAllTheWay) {
    double before = -1.0;
    for (int i = 0; i <= 100; ++i) {
        const auto [r, g, b] = heat_color(i / 100.0);
        // Green's map keeps this weighting of encoded values proportional to the position.
        const double brightness = 0.30 * r + 0.59 * g + 0.11 * b;
        EXPECT_GT(brightness, before) << i;
        before = brightness;
    }
    EXPECT_EQ(heat_color(0.0), (std::array<double, 3>{0, 0, 0}));
    EXPECT_EQ(heat_color(5.0), (std::array<double, 3>{1, 1, 1}));
}

TEST(HeatMap, ShowsTheScaleAndWhatIsLeftOut) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {3, 1, {"R", "G", "B"}, std::vector<float>(9, 0.0F)});
    write_test_image(folder / "b.exr", {3, 1, {"R", "G", "B"}, {0, 0, 0, 0.5F, 0, 0, 9, 9, 9}});
    write_test_image(folder / "m.exr", {3, 1, {"Y"}, {1, 1, 0}});
    CompareOptions options;
    options.mask = folder / "m.exr";
    const ImageComparison result = compare_images(folder / "a.exr", folder / "b.exr", options);
    EXPECT_EQ(write_heat_map(folder / "h.png", result), 0.5);
    const LinearImage picture = read_image(folder / "h.png");
    EXPECT_EQ(picture.text.at("skinglow:heat_map_white"), "0.5");
    EXPECT_EQ(picture.alpha, (std::vector<float>{1, 1, 0}));
    EXPECT_EQ(picture.rgb[0], 0.0F);
    EXPECT_EQ(picture.rgb[3], 1.0F);
    EXPECT_EQ(write_heat_map(folder / "h.png", result, 2.0), 2.0);
    EXPECT_LT(read_image(folder / "h.png").rgb[3], 0.5F);
    const ImageComparison same = compare_images(folder / "a.exr", folder / "a.exr");
    EXPECT_EQ(write_heat_map(folder / "h.png", same), 1.0) << "nothing differs: any scale shows it";
    expect_refused<FileError>([&] { write_heat_map(folder / "h.exr", result); }, {"h.exr", ".png"});
    expect_refused<std::invalid_argument>([&] { write_heat_map(folder / "h.png", result, 0.0); }, {"scale"});
}

}  // namespace
}  // namespace skinglow::test
