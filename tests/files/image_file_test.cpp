#include "files/image_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "files/color_encoding.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"
#include "test_image.h"

namespace skinglow::test {
namespace {

bool has_note(const LinearImage& image, const std::string& part) {
    for (const std::string& note : image.notes) {
        if (note.find(part) != std::string::npos) return true;
    }
    return false;
}

TEST(TransferFunction, KnownValuesAndInverse) {
    // 0.5 by the formula of IEC 61966-2-1, computed apart: ((0.5 + 0.055) / 1.055)^2.4.
    EXPECT_NEAR(srgb_to_linear(0.5), 0.21404114048223255, 1e-15);
    EXPECT_EQ(srgb_to_linear(0.0), 0.0);
    EXPECT_NEAR(srgb_to_linear(1.0), 1.0, 1e-15);
    for (const double value : {-2.0, -0.5, 0.001, 0.0031308, 0.04, 0.5, 0.99, 3.0}) {
        EXPECT_NEAR(srgb_to_linear(linear_to_srgb(value)), value, 1e-6 * std::abs(value)) << value;
    }
    EXPECT_EQ(quantize(-1.0, Encoding::srgb, 255), 0U);
    EXPECT_EQ(quantize(7.0, Encoding::linear, 65535), 65535U);
    EXPECT_EQ(quantize(0.21404114048223255, Encoding::srgb, 255), 128U);
}

TEST(ImageFile, FloatExrIsLinearToTheLastBit) {
    const ScratchFolder folder;
    const std::vector<float> values = {0.1F, 2.5F, -0.25F, 1e-30F, 1e30F, 0.0F};
    write_test_image(folder / "a.exr", {2, 1, {"R", "G", "B"}, values});
    const LinearImage image = read_image(folder / "a.exr");
    EXPECT_EQ(image.rgb, values);
    EXPECT_TRUE(image.alpha.empty());
    EXPECT_TRUE(image.notes.empty());
    EXPECT_FALSE(image.gray);
}

TEST(ImageFile, EightBitPngIsDecodedFromSrgbAndSaysSo) {
    const ScratchFolder folder;
    write_test_image(folder / "a.png",
                     {1, 1, {"R", "G", "B"}, {0.0F, 128.0F / 255.0F, 1.0F}, OIIO::TypeUInt8});
    const LinearImage image = read_image(folder / "a.png");
    EXPECT_EQ(image.rgb[0], 0.0F);
    EXPECT_NEAR(image.rgb[1], 0.21586050011389926, 1e-7);  // 128/255 by the formula
    EXPECT_EQ(image.rgb[2], 1.0F);
    EXPECT_TRUE(has_note(image, "sRGB"));
}

TEST(ImageFile, PngThatSaysLinearIsNotDecoded) {
    const ScratchFolder folder;
    write_test_image(
        folder / "a.png",
        {1, 1, {"R", "G", "B"}, {0.0F, 0.5F, 1.0F}, OIIO::TypeUInt16, {{"oiio:ColorSpace", "Linear"}}});
    const LinearImage image = read_image(folder / "a.png");
    EXPECT_NEAR(image.rgb[1], 0.5, 1e-5);
    EXPECT_TRUE(image.notes.empty());
}

TEST(ImageFile, StraightAlphaIsMultipliedAfterDecoding) {
    const ScratchFolder folder;
    // Written with OpenImageIO's own convention (multiplied), the PNG holds 128/255 beside alpha 128/255.
    TestImage png{
        1, 1, {"R", "G", "B", "A"}, {128.0F / 255.0F, 0.0F, 1.0F, 128.0F / 255.0F}, OIIO::TypeUInt8};
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeUInt8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create("a.png");
    ASSERT_TRUE(output->open((folder / "a.png").string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, png.values.data()));
    ASSERT_TRUE(output->close());
    const LinearImage image = read_image(folder / "a.png");
    ASSERT_EQ(image.alpha.size(), 1U);
    const double alpha = 128.0 / 255.0;
    EXPECT_NEAR(image.alpha[0], alpha, 1e-7);
    EXPECT_NEAR(image.rgb[0], 0.21586050011389926 * alpha, 1e-7);
    EXPECT_NEAR(image.rgb[2], alpha, 1e-7);
}

TEST(ImageFile, FindsBlendersCombinedLayer) {
    const ScratchFolder folder;
    const std::vector<std::string> channels = {
        "ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
        "ViewLayer.DiffDir.R",  "ViewLayer.DiffDir.G",  "ViewLayer.DiffDir.B",  "ViewLayer.Depth.Z"};
    write_test_image(folder / "a.exr", {1, 1, channels, {1, 2, 3, 0.5, 7, 8, 9, 100}, OIIO::TypeHalf});
    const LinearImage image = read_image(folder / "a.exr");
    EXPECT_EQ(image.rgb, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(image.alpha, std::vector<float>{0.5F});
}

TEST(ImageFile, RefusesLayersThatCouldEachBeMeant) {
    const ScratchFolder folder;
    const std::vector<std::string> channels = {"Left.R", "Left.G", "Left.B", "Right.R", "Right.G", "Right.B"};
    write_test_image(folder / "a.exr", {1, 1, channels, {1, 2, 3, 4, 5, 6}});
    expect_refused<FileError>([&] { read_image(folder / "a.exr"); }, {"a.exr", "2 layers", "Left.R"});
}

TEST(ImageFile, OneChannelIsGray) {
    const ScratchFolder folder;
    write_test_image(folder / "a.exr", {2, 1, {"Y"}, {0.25F, 0.5F}});
    const LinearImage image = read_image(folder / "a.exr");
    EXPECT_TRUE(image.gray);
    EXPECT_EQ(image.rgb, (std::vector<float>{0.25F, 0.25F, 0.25F, 0.5F, 0.5F, 0.5F}));
}

TEST(ImageFile, CroppedExrIsPutInItsPlace) {
    const ScratchFolder folder;
    OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeFloat);
    spec.x = 1;
    spec.y = 1;
    spec.full_width = 3;
    spec.full_height = 2;
    const std::vector<float> values = {4, 5, 6};
    const auto output = OIIO::ImageOutput::create("a.exr");
    ASSERT_TRUE(output->open((folder / "a.exr").string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, values.data()));
    ASSERT_TRUE(output->close());
    const LinearImage image = read_image(folder / "a.exr");
    ASSERT_EQ(image.width, 3);
    ASSERT_EQ(image.height, 2);
    std::vector<float> expected(18, 0.0F);
    expected[12] = 4;
    expected[13] = 5;
    expected[14] = 6;
    EXPECT_EQ(image.rgb, expected);
    EXPECT_EQ(image.alpha, (std::vector<float>{0, 0, 0, 0, 1, 0}));
}

TEST(ImageFile, RefusesFilesThatAreNoImage) {
    const ScratchFolder folder;
    expect_refused<FileError>([&] { read_image(folder / "none.exr"); }, {"none.exr", "does not exist"});
    expect_refused<FileError>([&] { read_image(folder.path()); }, {"is not a file"});
    for (const char* name : {"empty.exr", "empty.png", "text.png", "text.exr"}) {
        folder.write(name, std::string(name).starts_with("empty")
                               ? ""
                               : "this is a letter to a friend, not a picture");
        expect_refused<FileError>([&] { read_image(folder / name); }, {name, "image"});
    }
}

TEST(ImageFile, RefusesTruncatedFilesAtEveryLength) {
    const ScratchFolder folder;
    std::vector<float> values;
    values.reserve(64 * 64 * 3);
    for (int i = 0; i < 64 * 64 * 3; ++i) values.push_back(static_cast<float>((i * 7919) % 1009) / 1009.0F);
    for (const std::string name : {"a.exr", "a.png"}) {
        const auto type = name == "a.exr" ? OIIO::TypeFloat : OIIO::TypeUInt16;
        write_test_image(folder / name, {64, 64, {"R", "G", "B"}, values, type});
        const std::string whole = read_bytes(folder / name);
        // The last bytes of a PNG are its IEND chunk (12): without them no pixel is missing.
        const std::size_t longest = whole.size() - 13;
        for (std::size_t step = 0; step <= 20; ++step) {
            const std::size_t length = longest * step / 20;
            folder.write("cut-" + name, whole.substr(0, length));
            SCOPED_TRACE(name + " cut to " + std::to_string(length) + " of " + std::to_string(whole.size()));
            expect_refused<FileError>([&] { read_image(folder / ("cut-" + name)); }, {"cut-" + name});
        }
    }
}

TEST(ImageFile, PngThatEndsWithinAChunkIsRefusedByTheLastWholeOne) {
    const ScratchFolder folder;
    write_test_image(folder / "a.png", {2, 1, {"R", "G", "B"}, {0, 0, 0, 1, 1, 1}, OIIO::TypeUInt8});
    const std::string whole = read_bytes(folder / "a.png");
    folder.write("cut.png", whole.substr(0, whole.find("IDAT") + 6));
    expect_refused<FileError>([&] { read_image(folder / "cut.png"); },
                              {"cut.png", "after chunk", "ends before"});
    folder.write("head.png", whole.substr(0, 12));
    expect_refused<FileError>([&] { read_image(folder / "head.png"); }, {"head.png", "after its start"});
    folder.write("no_end.png", whole.substr(0, whole.size() - 12));
    expect_refused<FileError>([&] { read_image(folder / "no_end.png"); }, {"no_end.png", "after chunk IDAT"});
    folder.write("cut.exr", whole.substr(0, whole.size() - 20));  // by content, whatever its name
    expect_refused<FileError>([&] { read_image(folder / "cut.exr"); }, {"cut.exr", "ends before"});
    folder.write("more.png", whole + "appended by someone");
    EXPECT_EQ(read_image(folder / "more.png").width, 2);
}

TEST(ImageFile, ExrWithAnAttributeBeyondTheFileIsRefusedByIt) {
    const ScratchFolder folder;
    TestImage image{2, 1, {"R", "G", "B"}, {0, 0, 0, 1, 1, 1}};
    image.attributes = {{"Artist", "someone"}};
    write_test_image(folder / "a.exr", image);
    std::string bytes = read_bytes(folder / "a.exr");
    const std::size_t type = bytes.find("Artist") + 7;
    ASSERT_EQ(bytes.substr(type, 7), std::string("string\0", 7));
    bytes.replace(type + 7, 4, "MMMM");  // 1.3 GB
    folder.write("long.exr", bytes);
    expect_refused<FileError>([&] { read_image(folder / "long.exr"); },
                              {"long.exr", "attribute Artist", "longer than the file"});
    // OpenEXR would go on reading a header where these end by themselves.
    for (const std::string name : {"chlist", "box2i", "float"}) {
        bytes = read_bytes(folder / "a.exr");
        const std::size_t length = bytes.find(name + std::string(1, '\0')) + name.size() + 1;
        bytes[length] = static_cast<char>(bytes[length] + 1);
        folder.write("other.exr", bytes);
        expect_refused<FileError>([&] { read_image(folder / "other.exr"); },
                                  {"other.exr", "attribute ", "not what its type has"});
    }
}

TEST(ImageFile, RefusesHugeImagesByTheirHeader) {
    const ScratchFolder folder;
    folder.write("wide.pgm", "P5\n70000 1\n255\n");
    folder.write("huge.pgm", "P5\n60000 60000\n255\n");
    expect_refused<FileError>([&] { read_image(folder / "wide.pgm"); }, {"wide.pgm", "70000 x 1", "65536"});
    expect_refused<FileError>([&] { read_image(folder / "huge.pgm"); },
                              {"huge.pgm", "60000 x 60000", "67108864"});
}

TEST(ImageFile, RefusesPixelsThatAreNotFiniteAndNamesTheFirst) {
    const ScratchFolder folder;
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        std::vector<float> values(18, 0.5F);
        values[3 * 4 + 1] = bad;
        write_test_image(folder / "a.exr", {3, 2, {"R", "G", "B"}, values});
        expect_refused<FileError>([&] { read_image(folder / "a.exr"); }, {"a.exr", "pixel (1, 1)", "finite"});
    }
}

}  // namespace
}  // namespace skinglow::test
