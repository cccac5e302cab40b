#include "files/lut_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "files/image_file.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "test_image.h"

namespace skinglow::test {
namespace {

LutTable make_table(std::size_t size = 5) {
    LutTable table;
    for (std::size_t i = 0; i < size; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(size);
        table.colors.emplace_back(2.8 * std::exp(-t), 0.1 + t / 3.0, 1e-12 * t);
    }
    table.record.max_thickness_mm = 7.3;
    table.record.mode = LutMode::paper;
    table.record.light_weight = glm::dvec3(1.0 / 3.0, 0.87, 1e-300);
    table.record.blood_weight = glm::dvec3(1.8, 0.5, 0.4);
    table.record.coefficients = AttenuationCoefficients{1.0, 0.1, 0.7};
    return table;
}

void expect_same_record(const LutRecord& record, const LutRecord& expected) {
    EXPECT_EQ(record.max_thickness_mm, expected.max_thickness_mm);
    EXPECT_EQ(record.mode, expected.mode);
    EXPECT_EQ(record.light_weight, expected.light_weight);
    EXPECT_EQ(record.blood_weight, expected.blood_weight);
    ASSERT_TRUE(record.coefficients.has_value());
    EXPECT_EQ(record.coefficients->constant, expected.coefficients->constant);
    EXPECT_EQ(record.coefficients->linear, expected.coefficients->linear);
    EXPECT_EQ(record.coefficients->quadratic, expected.coefficients->quadratic);
}

TEST(LutFile, ExrRoundTripIsExactInFloat32AndInTheRecord) {
    const ScratchFolder folder;
    for (const std::size_t size : {std::size_t{1}, std::size_t{5}, max_lut_size}) {
        const LutTable table = make_table(size);
        EXPECT_EQ(write_lut(folder / "a.exr", table).clamped_texels, 0U);
        const LutFile file = read_lut(folder / "a.exr");
        ASSERT_EQ(file.table.colors.size(), size);
        for (std::size_t i = 0; i < size; ++i) {
            for (int channel = 0; channel < 3; ++channel) {
                ASSERT_EQ(file.table.colors[i][channel], static_cast<float>(table.colors[i][channel])) << i;
            }
        }
        expect_same_record(file.table.record, table.record);
        EXPECT_TRUE(file.notes.empty());
    }
}

TEST(LutFile, CsvRoundTripIsExactInDoubles) {
    const ScratchFolder folder;
    for (const std::size_t size : {std::size_t{1}, std::size_t{300}, max_lut_size}) {
        const LutTable table = make_table(size);
        write_lut(folder / "a.csv", table);
        const LutFile file = read_lut(folder / "a.csv");
        EXPECT_EQ(file.table.colors, table.colors);
        expect_same_record(file.table.record, table.record);
    }
    EXPECT_NE(read_bytes(folder / "a.csv").find("\nthickness_mm,r,g,b\n"), std::string::npos);
}

TEST(LutFile, CsvWithWindowsLineEndsIsRead) {
    const ScratchFolder folder;
    const LutTable table = make_table();
    write_lut(folder / "a.csv", table);
    std::string text;
    for (const char letter : read_bytes(folder / "a.csv"))
        text += letter == '\n' ? std::string("\r\n") : std::string(1, letter);
    folder.write("b.csv", text);
    EXPECT_EQ(read_lut(folder / "b.csv").table.colors, table.colors);
}

TEST(LutFile, PngHoldsItsEncodingAndRoundsToHalfALevel) {
    const ScratchFolder folder;
    LutTable table = make_table(64);
    for (glm::dvec3& color : table.colors) color /= 3.0;
    for (const int bits : {8, 16}) {
        for (const Encoding encoding : {Encoding::srgb, Encoding::linear}) {
            EXPECT_EQ(write_lut(folder / "a.png", table, {bits, encoding}).clamped_texels, 0U);
            const LutFile file = read_lut(folder / "a.png");
            expect_same_record(file.table.record, table.record);
            EXPECT_EQ(file.notes.empty(), encoding == Encoding::linear) << "decoding is said";
            const double half_level = 0.5 / (bits == 8 ? 255.0 : 65535.0) + 1e-7;
            for (std::size_t i = 0; i < table.colors.size(); ++i) {
                for (int c = 0; c < 3; ++c) {
                    const double found = file.table.colors[i][c];
                    const double wanted = table.colors[i][c];
                    if (encoding == Encoding::srgb) {
                        ASSERT_NEAR(linear_to_srgb(found), linear_to_srgb(wanted), half_level) << i;
                    } else {
                        ASSERT_NEAR(found, wanted, half_level) << i;
                    }
                }
            }
            const LinearImage image = read_image(folder / "a.png");
            EXPECT_EQ(image.text.at("skinglow:encoding"), encoding == Encoding::srgb ? "sRGB" : "linear");
        }
    }
}

TEST(LutFile, PngCountsClampedTexels) {
    const ScratchFolder folder;
    LutTable table = make_table(4);
    table.colors = {{1.0, 0.0, 0.5}, {1.0000001, 0.0, 0.0}, {0.0, -1e-9, 0.0}, {2.0, 3.0, 4.0}};
    EXPECT_EQ(write_lut(folder / "a.png", table).clamped_texels, 3U);
    EXPECT_EQ(read_lut(folder / "a.png").table.colors[3], glm::dvec3(1.0));
}

TEST(LutFile, RefusesUnknownExtensions) {
    const ScratchFolder folder;
    for (const char* name : {"a.jpg", "a", "a.exr.txt"}) {
        expect_refused<FileError>([&] { write_lut(folder / name, make_table()); },
                                  {name, "extension", ".exr, .png or .csv"});
    }
    EXPECT_TRUE(folder.names().empty());
}

TEST(LutFile, RefusesTablesThatAreNoTables) {
    const ScratchFolder folder;
    LutTable table = make_table();
    table.colors[2].g = std::numeric_limits<double>::quiet_NaN();
    for (const char* name : {"a.exr", "a.png", "a.csv"}) {
        expect_refused<std::invalid_argument>([&] { write_lut(folder / name, table); },
                                              {"entry 2", "finite"});
        expect_refused<std::invalid_argument>(
            [&] {
                write_lut(folder / name, LutTable{{}, table.record});
            },
            {"size is 0"});
    }
    table = make_table();
    table.record.max_thickness_mm = 0.0;
    expect_refused<std::invalid_argument>([&] { write_lut(folder / "a.exr", table); },
                                          {"max_thickness_mm is 0"});
    expect_refused<std::invalid_argument>(
        [&] {
            write_lut(folder / "a.png", make_table(), {12, Encoding::srgb});
        },
        {"bits is 12"});
    table = make_table();
    table.colors[1].r = 1e39;
    expect_refused<FileError>([&] { write_lut(folder / "a.exr", table); }, {"a.exr", "texel 1", "float32"});
    EXPECT_TRUE(folder.names().empty()) << "what is refused leaves no file";
}

TEST(LutFile, RefusesFoldersThatCannotBeWritten) {
    for (const char* name : {"/proc/a.exr", "/proc/a.png", "/proc/a.csv"}) {
        expect_refused<FileError>([&] { write_lut(name, make_table()); },
                                  {name, "cannot be written", "choose a folder"});
    }
}

TEST(LutFile, RefusesForeignImagesAndDamagedRecords) {
    const ScratchFolder folder;
    write_test_image(folder / "plain.exr", {2, 1, {"R", "G", "B"}, {1, 2, 3, 4, 5, 6}});
    expect_refused<FileError>([&] { read_lut(folder / "plain.exr"); },
                              {"plain.exr", "skinglow:max_thickness_mm", "base lookup"});
    const auto with = [&](const std::string& key, const std::string& value) {
        write_test_image(folder / "bad.exr", {1,
                                              1,
                                              {"R", "G", "B"},
                                              {1, 2, 3},
                                              OIIO::TypeFloat,
                                              {{"skinglow:max_thickness_mm", "5"}, {key, value}}});
        expect_refused<FileError>([&] { read_lut(folder / "bad.exr"); }, {"bad.exr", key, value});
    };
    for (const char* value : {"0", "-1", "nan", "inf", "5 mm", "1e999"})
        with("skinglow:max_thickness_mm", value);
    for (const char* value : {"1 2", "1 2 3 4", "1,2,3", "1 nan 3"}) with("skinglow:light_weight", value);
}

TEST(LutFile, RefusesDamagedCsvAndNamesTheLine) {
    const ScratchFolder folder;
    write_lut(folder / "a.csv", make_table());
    const std::string whole = read_bytes(folder / "a.csv");
    const auto expect_bad = [&](const std::string& text, const std::vector<std::string>& parts) {
        folder.write("bad.csv", text);
        expect_refused<FileError>([&] { read_lut(folder / "bad.csv"); }, parts);
    };
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string text = whole;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    expect_bad("", {"bad.csv", "ends too early"});
    expect_bad(whole.substr(0, whole.size() - 1), {"ends too early"});
    expect_bad(whole.substr(0, whole.rfind('\n', whole.size() - 2) + 1), {"is due", "line "});
    expect_bad(replaced("\n0,", "\nzero,"), {"line 9", "zero", "finite"});
    expect_bad(replaced("\n0,", "\n0,nan,"), {"line 9", "nan"});
    expect_bad(replaced("\n0,", "\n0,1,"), {"line 9", "more than four"});
    expect_bad(replaced("thickness_mm,r", "mm,r"), {"line 8", "thickness_mm,r,g,b"});
    expect_bad(replaced("# skinglow:max_thickness_mm", "# max"), {"skinglow:max_thickness_mm"});
}

TEST(LutPreview, IsAPictureFromThinToThick) {
    const ScratchFolder folder;
    LutTable table = make_table(2);
    table.colors = {{1.0, 0.5, 0.25}, {0.0, 0.0, 0.0}};
    EXPECT_EQ(write_lut_preview(folder / "p.png", table).clamped_texels, 0U);
    const LinearImage image = read_image(folder / "p.png");
    EXPECT_EQ(image.width, 512);
    EXPECT_EQ(image.height, 64);
    EXPECT_NEAR(image.rgb[1], 0.5, 0.005);
    EXPECT_EQ(image.rgb[3 * 511], 0.0F);
    EXPECT_NEAR(image.rgb[3 * 256], 0.5, 0.005) << "linear light between entries";
    expect_refused<FileError>([&] { write_lut_preview(folder / "p.exr", table); }, {"p.exr", ".png"});
    expect_refused<std::invalid_argument>([&] { write_lut_preview(folder / "q.png", table, 0); },
                                          {"width is 0"});
}

}  // namespace
}  // namespace skinglow::test
