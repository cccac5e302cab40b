#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace skinglow::test {

struct TestImage {
    int width = 1;
    int height = 1;
    std::vector<std::string> channels{"R", "G", "B"};
    std::vector<float> values{};
    OIIO::TypeDesc type = OIIO::TypeFloat;
    std::vector<std::pair<std::string, std::string>> attributes{};
};

/// Writes by OpenImageIO alone, so that what reads is tested against a writer that is not ours.
inline void write_test_image(const std::filesystem::path& path, const TestImage& image) {
    OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), image.type);
    spec.channelnames = image.channels;
    spec.alpha_channel = -1;
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        if (image.channels[i] == "A") spec.alpha_channel = static_cast<int>(i);
    }
    for (const auto& [key, value] : image.attributes) spec.attribute(key, value);
    const auto output = OIIO::ImageOutput::create(path.string());
    if (!output || !output->open(path.string(), spec) ||
        !output->write_image(OIIO::TypeFloat, image.values.data()) || !output->close()) {
        throw std::runtime_error("test image " + path.string() + " was not written");
    }
}

using PixelByChannel = std::map<std::string, float>;

/// The first pixel of a float image, read by OpenImageIO alone.
inline PixelByChannel read_first_pixel(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw std::runtime_error("test image " + path.string() + " was not read");
    const OIIO::ImageSpec spec = input->spec();
    std::vector<float> values(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, values.data()))
        throw std::runtime_error("no pixels");
    PixelByChannel pixel;
    for (std::size_t i = 0; i < spec.channelnames.size(); ++i) pixel[spec.channelnames[i]] = values[i];
    return pixel;
}

}  // namespace skinglow::test
