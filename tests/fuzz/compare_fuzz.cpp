// Comparisons of two small pictures: finite figures that agree with each other.

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <memory>
#include <vector>

#include "file_target.h"
#include "files/image_compare.h"
#include "fuzz_input.h"

namespace {

std::filesystem::path picture(const char* name, skinglow::fuzz::FuzzInput& input, int width, int height,
                              int channels) {
    const auto path = skinglow::fuzz::scratch_file(name);
    std::vector<float> values(static_cast<std::size_t>(width * height * channels));
    for (float& value : values) value = static_cast<float>(input.near_range(0.0, 1.0));
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeFloat);
    spec.attribute("compression", "none");
    const auto output = OIIO::ImageOutput::create(path.string());
    skinglow::fuzz::require(output && output->open(path.string(), spec) &&
                                output->write_image(OIIO::TypeFloat, values.data()) && output->close(),
                            "a picture is written");
    return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow::detail;
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    CompareOptions options;
    options.ignore_edges = input.flag();
    options.ignore_background = input.flag();
    options.peak = input.near_range(0.1, 2.0);
    const int width = static_cast<int>(1 + input.below(5)), height = static_cast<int>(1 + input.below(5));
    const auto first = picture("first.exr", input, width, height, input.flag() ? 4 : 3);
    const auto second =
        picture("second.exr", input, width + (input.byte() % 16 == 0 ? 1 : 0), height, input.flag() ? 4 : 3);
    if (input.flag()) options.mask = picture("mask.exr", input, width, height, 1);
    try {
        runs([&] {
            const ImageComparison c = compare_images(first, second, options);
            require(std::isfinite(c.total.rms) && c.total.rms >= 0 && c.total.rms <= c.total.max * (1 + 1e-9),
                    "RMS is at most the largest difference");
            require(c.compared_pixels + c.left_out_pixels == static_cast<std::size_t>(width * height),
                    "each pixel is compared or left out");
            require(c.compared_pixels > 0, "something is compared");
            for (const double channel : {c.channel[0].max, c.channel[1].max, c.channel[2].max})
                require(channel <= c.total.max, "no channel is further off than all");
        });
    } catch (const FileError& refusal) {
        require(std::string(refusal.what()).find('\n') == std::string::npos, "a refusal is one line");
    }
    return 0;
}
