#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "files/image_file.h"
#include "mesh_samples.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "test_image.h"

/// What a picture says about its own colors, parts and numbers. OpenImageIO writes the pictures; the chunks that it
/// does not write are put into its PNG.
namespace skinglow::test {
namespace {

/// CRC of a chunk: W3C, "Portable Network Graphics", annex D.
std::uint32_t checksum(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? 0xEDB88320U ^ crc >> 1U : crc >> 1U;
    }
    return ~crc;
}

struct Chunk {
    std::string name;
    std::string data;
};

std::string words(const std::vector<std::uint32_t>& values) {
    std::string bytes;
    for (const std::uint32_t value : values) append(bytes, value, true);
    return bytes;
}

/// A pixel of R, G, B as a 16-bit PNG with these chunks.
LinearImage read_png(const std::vector<float>& pixel, const std::vector<Chunk>& chunks) {
    const ScratchFolder folder;
    write_test_image(folder / "plain.png", {1, 1, {"R", "G", "B"}, pixel, OIIO::TypeUInt16});
    const std::string plain = read_bytes(folder / "plain.png");
    const std::size_t header_end = 8 + 25;  // the signature and the chunk IHDR
    std::string added;
    for (const Chunk& chunk : chunks) {
        append(added, static_cast<std::uint32_t>(chunk.data.size()), true);
        added += chunk.name + chunk.data;
        append(added, checksum(chunk.name + chunk.data), true);
    }
    return read_image(folder.write("a.png", plain.substr(0, header_end) + added + plain.substr(header_end)));
}

void expect_color(const LinearImage& image, const std::array<double, 3>& wanted, double tolerance = 2e-4) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(image.rgb[i], wanted[i], tolerance) << i;
}

bool has_note(const LinearImage& image, const std::string& part) {
    for (const std::string& note : image.notes) {
        if (note.find(part) != std::string::npos) return true;
    }
    return false;
}

const Chunk srgb{"sRGB", std::string(1, '\0')};
Chunk cicp(char primaries, char transfer) {
    return {"cICP", {primaries, transfer, '\0', '\x01'}};
}

TEST(PictureColor, PngTransferFunctions) {
    const std::vector<float> gray = {0.5F, 0.5F, 0.5F};
    const double as_srgb = 0.21404114048223255;
    const auto expect_gray = [&](const std::vector<Chunk>& chunks, double wanted) {
        expect_color(read_png(gray, chunks), {wanted, wanted, wanted}, 2e-5);
    };
    expect_gray({}, as_srgb);
    expect_gray({srgb}, as_srgb);
    expect_gray({{"gAMA", words({100000})}}, 0.5);
    expect_gray({{"gAMA", words({50000})}}, 0.25);
    expect_gray({srgb, {"gAMA", words({100000})}}, as_srgb);  // sRGB goes before gAMA
    expect_gray({cicp(1, 13)}, as_srgb);
    expect_gray({cicp(1, 8)}, 0.5);
    expect_gray({cicp(1, 4)}, std::pow(0.5, 2.2));
    expect_gray({cicp(1, 5)}, std::pow(0.5, 2.8));
    expect_gray({cicp(1, 8), srgb}, 0.5);  // cICP goes before everything
    for (const auto& [chunk, word] : {std::pair(cicp(9, 16), "PQ"),
                                      {cicp(9, 18), "HLG"},
                                      {cicp(1, 77), "77"},
                                      {cicp(5, 8), "primaries 5"}}) {
        expect_refused<FileError>([&, c = chunk] { read_png(gray, {c}); }, {"a.png", "cICP", word});
    }
    EXPECT_TRUE(has_note(read_png(gray, {{"iCCP", std::string("Wide\0\0", 6)}}), "\"Wide\" is not read"));
}

// Red and gray of the source in Rec.709: ITU-R BT.2087 and SMPTE EG 432-1 have the matrices.
TEST(PictureColor, PrimariesOfPngAndExr) {
    const std::array<double, 3> rec2020_red = {1.6605, -0.1246, -0.0182};
    const std::array<double, 3> p3_red = {1.2249, -0.0421, -0.0196};
    expect_color(read_png({1, 0, 0}, {cicp(9, 8)}), rec2020_red);
    expect_color(read_png({1, 0, 0}, {cicp(12, 8)}), p3_red);
    const Chunk p3{"cHRM", words({31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000})};
    expect_color(read_png({1, 0, 0}, {p3, {"gAMA", words({100000})}}), p3_red);
    expect_color(read_png({1, 1, 1}, {p3, {"gAMA", words({45455})}}), {1, 1, 1});

    const ScratchFolder folder;
    const auto read_exr = [&](std::array<float, 8> chromaticities, const std::vector<float>& pixel) {
        OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeHalf);
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities.data());
        const auto output = OIIO::ImageOutput::create("a.exr");
        EXPECT_TRUE(output->open((folder / "a.exr").string(), spec));
        EXPECT_TRUE(output->write_image(OIIO::TypeFloat, pixel.data()) && output->close());
        return read_image(folder / "a.exr");
    };
    const auto converted =
        read_exr({0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F}, {1, 0, 0});
    expect_color(converted, rec2020_red, 1e-3);
    EXPECT_TRUE(has_note(converted, "primaries"));
    // Another white goes to white.
    expect_color(read_exr({0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3457F, 0.3585F}, {1, 1, 1}),
                 {1, 1, 1});
    const auto own = read_exr({0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F}, {0.25F, 0.5F, 1});
    EXPECT_EQ(own.rgb, (std::vector<float>{0.25F, 0.5F, 1}));
    EXPECT_TRUE(own.notes.empty());
    EXPECT_TRUE(
        has_note(read_exr({0.3F, 0.3F, 0.3F, 0.3F, 0.3F, 0.3F, 0.3F, 0.3F}, {1, 1, 1}), "span no colors"));
    EXPECT_TRUE(has_note(read_exr({0.6F, 0, 0.3F, 0.6F, 0.1F, 0, 0.3F, 0.3F}, {1, 1, 1}), "span no colors"));
}

TEST(PictureColor, NumbersOfExr) {
    const ScratchFolder folder;
    const std::vector<float> values = {0.5F, 0.25F, 3.0F};
    write_test_image(folder / "half.exr", {1, 1, {"R", "G", "B"}, values, OIIO::TypeHalf});
    EXPECT_EQ(read_image(folder / "half.exr").rgb, values);
    write_test_image(folder / "uint.exr", {1, 1, {"R", "G", "B"}, {1, 2, 3}, OIIO::TypeUInt32});
    expect_refused<FileError>([&] { read_image(folder / "uint.exr"); }, {"uint.exr", "whole numbers", "R"});
}

struct Part {
    std::string name;
    std::vector<std::string> channels;
    std::vector<float> values;
};

void write_parts(const std::filesystem::path& path, const std::vector<Part>& parts) {
    std::vector<OIIO::ImageSpec> specs;
    for (const Part& part : parts) {
        specs.emplace_back(1, 1, static_cast<int>(part.channels.size()), OIIO::TypeFloat);
        specs.back().channelnames = part.channels;
        specs.back().attribute("oiio:subimagename", part.name);
    }
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output->open(path.string(), static_cast<int>(specs.size()), specs.data()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) {
            ASSERT_TRUE(output->open(path.string(), specs[i], OIIO::ImageOutput::AppendSubimage));
        }
        ASSERT_TRUE(output->write_image(OIIO::TypeFloat, parts[i].values.data()));
    }
    ASSERT_TRUE(output->close());
}

TEST(PictureColor, PartsOfExr) {
    const ScratchFolder folder;
    const std::vector<std::string> rgb = {"R", "G", "B"};
    const std::vector<std::string> combined = {"View.Combined.R", "View.Combined.G", "View.Combined.B"};
    const std::vector<std::string> diffuse = {"View.Diffuse.R", "View.Diffuse.G", "View.Diffuse.B"};
    write_parts(folder / "a.exr", {{"depth", {"Z"}, {7}}, {"beauty", rgb, {1, 2, 3}}});
    EXPECT_EQ(read_image(folder / "a.exr").rgb, (std::vector<float>{1, 2, 3}));
    write_parts(folder / "a.exr", {{"diffuse", diffuse, {4, 5, 6}}, {"all", combined, {1, 2, 3}}});
    const LinearImage image = read_image(folder / "a.exr");
    EXPECT_EQ(image.rgb, (std::vector<float>{1, 2, 3}));
    EXPECT_TRUE(has_note(image, "View.Diffuse"));
    write_parts(folder / "a.exr", {{"left", rgb, {1, 2, 3}}, {"right", rgb, {4, 5, 6}}});
    expect_refused<FileError>([&] { read_image(folder / "a.exr"); }, {"2 layers", "left", "right"});
}

}  // namespace
}  // namespace skinglow::test
