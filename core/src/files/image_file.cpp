#include "files/image_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "files/image_input.h"
#include "files/transfer_function.h"
#include "rig_files/file_error.h"

namespace skinglow {
namespace {

/// Places of the color channels within an image part; all three alike for gray.
struct ColorChannels {
    std::array<int, 3> rgb{};
    std::optional<int> alpha;
};

std::optional<int> find_channel(const OIIO::ImageSpec& spec, std::string_view name) {
    for (int i = 0; i < spec.nchannels; ++i) {
        if (spec.channelnames[static_cast<std::size_t>(i)] == name) return i;
    }
    return std::nullopt;
}

/// The channels "<layer>R", "<layer>G", "<layer>B", and "<layer>A" if there is one.
std::optional<ColorChannels> layer_channels(const OIIO::ImageSpec& spec, const std::string& layer) {
    const auto red = find_channel(spec, layer + "R");
    const auto green = find_channel(spec, layer + "G");
    const auto blue = find_channel(spec, layer + "B");
    if (!red || !green || !blue) return std::nullopt;
    return ColorChannels{{*red, *green, *blue}, find_channel(spec, layer + "A")};
}

/// Prefixes ("ViewLayer.Combined.") of the layers that hold a color.
std::vector<std::string> color_layers(const OIIO::ImageSpec& spec) {
    std::vector<std::string> layers;
    for (const std::string& name : spec.channelnames) {
        if (!name.ends_with(".R")) continue;
        const std::string layer = name.substr(0, name.size() - 1);
        if (layer_channels(spec, layer)) layers.push_back(layer);
    }
    return layers;
}

std::optional<ColorChannels> find_color(const ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    if (auto plain = layer_channels(spec, "")) return plain;
    std::vector<std::string> layers = color_layers(spec);
    std::vector<std::string> combined;
    std::copy_if(layers.begin(), layers.end(), std::back_inserter(combined), [](const std::string& layer) {
        return layer == "Combined." || layer.ends_with(".Combined.");
    });
    if (!combined.empty()) layers = combined;
    if (layers.size() == 1) return layer_channels(spec, layers.front());
    if (layers.size() > 1) {
        refuse_file(input.path(),
                    "has " + std::to_string(layers.size()) + " layers of color, such as " + layers[0] + "R",
                    "write the one you mean to a file of its own");
    }
    if (spec.nchannels == 1) return ColorChannels{{0, 0, 0}, std::nullopt};
    if (spec.nchannels == 2) return ColorChannels{{0, 0, 0}, 1};  // gray and alpha
    return std::nullopt;
}

/// The exponent of a color space that OpenImageIO names "GammaX.Y" (a PNG with a gamma of its own).
std::optional<double> gamma_exponent(const OIIO::ImageSpec& spec) {
    const float gamma = spec.get_float_attribute("oiio:Gamma", 0.0F);
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    if (space.starts_with("Gamma") && gamma > 0.0F && std::isfinite(gamma)) return gamma;
    return std::nullopt;
}

/// Makes values linear in place by what the file says of itself.
void decode(LinearImage& image, const OIIO::ImageSpec& spec) {
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    const auto own = image.text.find("skinglow:encoding");
    const bool floats = spec.format.is_floating_point();
    if (own != image.text.end() ? own->second == "linear"
                                : (space == "Linear" || (floats && space != "sRGB")))
        return;
    if (const auto exponent = gamma_exponent(spec); exponent && own == image.text.end()) {
        if (std::abs(*exponent - 1.0) < 0.01) return;  // gAMA holds 5 digits; 1 means linear
        for (float& value : image.rgb) value = static_cast<float>(std::pow(std::max(value, 0.0F), *exponent));
        image.notes.push_back("its values were decoded from gamma " + std::to_string(*exponent) +
                              " to linear light");
        return;
    }
    for (float& value : image.rgb) value = static_cast<float>(srgb_to_linear(value));
    image.notes.emplace_back("its values were decoded from sRGB to linear light");
}

void multiply_by_alpha(LinearImage& image) {
    for (std::size_t i = 0; i < image.alpha.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) image.rgb[3 * i + channel] *= image.alpha[i];
    }
}

/// Puts the data window into the whole picture, black around it.
template <int channels>
std::vector<float> in_full_window(const std::vector<float>& data, const OIIO::ImageSpec& spec) {
    std::vector<float> full(static_cast<std::size_t>(spec.full_width) *
                            static_cast<std::size_t>(spec.full_height) * channels);
    for (int y = 0; y < spec.height; ++y) {
        const int row = y + spec.y - spec.full_y;
        const int first = std::max(0, spec.full_x - spec.x);
        const int last = std::min(spec.width, spec.full_x + spec.full_width - spec.x);
        if (row < 0 || row >= spec.full_height || first >= last) continue;
        const auto* source = data.data() + (std::ptrdiff_t{y} * spec.width + first) * channels;
        std::copy_n(
            source, std::ptrdiff_t{last - first} * channels,
            full.data() + (std::ptrdiff_t{row} * spec.full_width + first + spec.x - spec.full_x) * channels);
    }
    return full;
}

void fill_full_window(LinearImage& image, const OIIO::ImageSpec& spec) {
    if (spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width &&
        spec.height == spec.full_height) {
        return;
    }
    if (image.alpha.empty()) image.alpha.assign(image.pixels(), 1.0F);
    image.rgb = in_full_window<3>(image.rgb, spec);
    image.alpha = in_full_window<1>(image.alpha, spec);
    image.width = spec.full_width;
    image.height = spec.full_height;
    image.notes.emplace_back("its data window was put into the whole picture, black around it");
}

}  // namespace

LinearImage read_image(const std::filesystem::path& path) {
    ImageInput input(path);
    auto color = find_color(input);
    while (!color && input.next_part()) color = find_color(input);
    const OIIO::ImageSpec& spec = input.spec();
    if (!color) {
        refuse_file(path, "has no channels R, G and B, nor one alone (first: " + spec.channelnames[0] + ")",
                    "write it as a color or gray image");
    }
    LinearImage image;
    image.width = spec.width;
    image.height = spec.height;
    image.gray = color->rgb[0] == color->rgb[1];
    image.text = input.text();
    std::array<int, 4> wanted = {color->rgb[0], color->rgb[1], color->rgb[2],
                                 color->alpha.value_or(color->rgb[0])};
    const auto [low, high] = std::minmax_element(wanted.begin(), wanted.end());
    const int begin = *low;
    const int end = *high + 1;
    const std::vector<float> values = input.read_channels(begin, end);
    const auto stride = static_cast<std::size_t>(end - begin);
    image.rgb.resize(image.pixels() * 3);
    if (color->alpha) image.alpha.resize(image.pixels());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            image.rgb[3 * i + channel] =
                values[i * stride + static_cast<std::size_t>(wanted[channel] - begin)];
        }
        if (color->alpha) image.alpha[i] = values[i * stride + static_cast<std::size_t>(wanted[3] - begin)];
    }
    decode(image, spec);
    if (spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) multiply_by_alpha(image);
    fill_full_window(image, spec);
    if (std::any_of(image.rgb.begin(), image.rgb.end(), [](float value) { return !std::isfinite(value); })) {
        refuse_file(path, "holds a value whose linear light is beyond float32",
                    "write it anew with smaller values");
    }
    return image;
}

RawChannels read_raw_channels(const std::filesystem::path& path, const std::vector<std::string>& names) {
    ImageInput input(path);
    const OIIO::ImageSpec& spec = input.spec();
    RawChannels raw{spec.width, spec.height, {}, input.text()};
    for (const std::string& name : names) {
        const auto place = find_channel(spec, name);
        if (!place) refuse_file(path, "has no channel " + name, "give a file that has it");
        raw.channels.push_back(input.read_channels(*place, *place + 1));
    }
    return raw;
}

bool has_channels(const std::filesystem::path& path, const std::vector<std::string>& names) {
    const ImageInput input(path);
    return std::all_of(names.begin(), names.end(),
                       [&](const std::string& name) { return find_channel(input.spec(), name).has_value(); });
}

}  // namespace skinglow
