#include <gtest/gtest.h>
#include <skinglow/lut.h>

#include "files/lut_file.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "test_image.h"

namespace skinglow::test {
namespace {

bool has_note(const BaseLutFile& file, const std::string& part) {
    for (const std::string& note : file.notes) {
        if (note.find(part) != std::string::npos) return true;
    }
    return false;
}

TEST(BaseLutFile, GrayImageIsItsBrightness) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {3, 1, {"Y"}, {1.0F, 0.3F, 0.1F}});
    const BaseLutFile file = read_base_lut(folder / "a.exr", 5.0);
    ASSERT_EQ(file.base.size(), 3U);
    EXPECT_EQ(file.base.axis().max_thickness_mm(), 5.0);
    EXPECT_EQ(file.base.matrices()[1], glm::dmat3(0.3F));
    EXPECT_TRUE(file.notes.empty());
}

TEST(BaseLutFile, ColorIsReducedToLuminanceAndSaid) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {1, 1, {"R", "G", "B"}, {0.5F, 0.25F, 0.125F}});
    const BaseLutFile file = read_base_lut(folder / "a.exr", 5.0);
    EXPECT_NEAR(file.base.matrices()[0][0][0], 0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722 * 0.125, 1e-15);
    EXPECT_TRUE(has_note(file, "luminance"));
}

TEST(BaseLutFile, EncodedColorIsDecodedBeforeItIsReduced) {
    const ScratchFolder folder;
    write_test_image(folder / "a.png",
                     {1, 1, {"R", "G", "B"}, {1.0F, 0.0F, 128.0F / 255.0F}, OIIO::TypeUInt8});
    const BaseLutFile file = read_base_lut(folder / "a.png", 5.0);
    EXPECT_NEAR(file.base.matrices()[0][0][0], 0.2126 + 0.0722 * 0.21586050011389926, 1e-8);
    EXPECT_TRUE(has_note(file, "sRGB"));
}

TEST(BaseLutFile, RowsAreAveragedAndEqualRowsStayExact) {
    const ScratchFolder folder;
    write_test_image(folder / "differ.exr", {2, 2, {"Y"}, {1.0F, 0.5F, 0.5F, 0.0F}});
    const BaseLutFile differ = read_base_lut(folder / "differ.exr", 5.0);
    EXPECT_EQ(differ.base.matrices()[0][0][0], 0.75);
    EXPECT_EQ(differ.base.matrices()[1][0][0], 0.25);
    EXPECT_TRUE(has_note(differ, "2 rows differ"));
    std::vector<float> rows;
    for (int i = 0; i < 7; ++i) rows.insert(rows.end(), {0.1F, 0.7F, 0.3F});
    write_test_image(folder / "same.exr", {3, 7, {"Y"}, rows});
    const BaseLutFile same = read_base_lut(folder / "same.exr", 5.0);
    EXPECT_EQ(same.base.matrices()[1][0][0], 0.7F);
    EXPECT_TRUE(same.notes.empty());
}

TEST(BaseLutFile, AxisIsAskedElseTheFilesElseTheDefaultAndSaid) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {1, 1, {"Y"}, {1.0F}});
    const BaseLutFile plain = read_base_lut(folder / "a.exr");
    EXPECT_EQ(plain.base.axis().max_thickness_mm(), 12.0);
    EXPECT_TRUE(has_note(plain, "12 mm"));
    LutTable table{{glm::dvec3(0.5)}, {}};
    table.record.max_thickness_mm = 3.5;
    write_lut(folder / "b.exr", table);
    EXPECT_EQ(read_base_lut(folder / "b.exr").base.axis().max_thickness_mm(), 3.5);
    EXPECT_EQ(read_base_lut(folder / "b.exr", 4.0).base.axis().max_thickness_mm(), 4.0);
    expect_refused<std::invalid_argument>([&] { read_base_lut(folder / "b.exr", -4.0); },
                                          {"max_thickness_mm is -4"});
}

const std::vector<std::string> matrix_channels = {"M00", "M01", "M02", "M10", "M11",
                                                  "M12", "M20", "M21", "M22"};

void write_matrices(const std::filesystem::path& path, const std::vector<glm::dmat3>& matrices,
                    const std::string& max_thickness_mm) {
    std::vector<float> values;
    for (const glm::dmat3& matrix : matrices) {
        for (int i = 0; i < 9; ++i) values.push_back(static_cast<float>(matrix[i % 3][i / 3]));
    }
    write_test_image(path, {static_cast<int>(matrices.size()),
                            1,
                            matrix_channels,
                            values,
                            OIIO::TypeFloat,
                            {{"skinglow:table", "base"}, {"skinglow:max_thickness_mm", max_thickness_mm}}});
}

TEST(BaseLutFile, MatricesAreReadExactlyInFloat32) {
    const ScratchFolder folder;
    std::vector<glm::dmat3> matrices(300);
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        for (int column = 0; column < 3; ++column) {
            for (int row = 0; row < 3; ++row) {
                // Unlike everywhere, so that a swapped row and column shows; float32, so that the trip is
                // exact.
                matrices[i][column][row] =
                    static_cast<float>(0.01 * static_cast<double>(i) + 0.1 * column - 0.037 * row);
            }
        }
    }
    write_matrices(folder / "m.exr", matrices, "6.25");
    const BaseLutFile file = read_base_lut(folder / "m.exr");
    EXPECT_EQ(file.base.axis().max_thickness_mm(), 6.25);
    ASSERT_EQ(file.base.size(), 300U);
    for (std::size_t i = 0; i < 300; ++i) ASSERT_EQ(file.base.matrices()[i], matrices[i]) << i;
    EXPECT_TRUE(file.notes.empty());
}

TEST(BaseLutFile, ChannelMijTakesChannelJToChannelI) {
    const ScratchFolder folder;
    glm::dmat3 matrix(0.0);
    matrix[2][0] = 0.5;  // GLM: column 2, row 0: blue light comes through as red
    write_matrices(folder / "m.exr", {matrix}, "1");
    EXPECT_EQ(read_first_pixel(folder / "m.exr").at("M02"), 0.5F);
    EXPECT_EQ(read_base_lut(folder / "m.exr").base.matrices()[0], matrix);
}

TEST(BaseLutFile, RefusesMatricesInSeveralRows) {
    const ScratchFolder folder;
    write_test_image(folder / "m.exr", {1, 2, matrix_channels, std::vector<float>(18, 0.5F)});
    expect_refused<FileError>([&] { read_base_lut(folder / "m.exr"); }, {"m.exr", "2 rows", "has one"});
}

TEST(BaseLutFile, RefusesNegativeBrightnessAndTooWideImages) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {2, 1, {"Y"}, {1.0F, -0.5F}});
    expect_refused<FileError>([&] { read_base_lut(folder / "a.exr", 5.0); }, {"a.exr", "column 1", "-0.5"});
    folder.write("wide.pgm", "P5\n65537 1\n255\n");
    expect_refused<FileError>([&] { read_base_lut(folder / "wide.pgm", 5.0); }, {"wide.pgm", "65537"});
}

TEST(BaseLutFile, TakesTheLargestTable) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {65536, 1, {"Y"}, std::vector<float>(65536, 0.5F)});
    EXPECT_EQ(read_base_lut(folder / "a.exr", 5.0).base.size(), max_lut_size);
}

}  // namespace
}  // namespace skinglow::test
