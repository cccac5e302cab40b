#include "files/image_file.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "files/color_encoding.h"
#include "files/image_io.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

/// How the file's numbers stand for light, by its own words; where it has none, floats are linear and whole
/// numbers sRGB.
ColorEncoding encoding_of(const LinearImage& image, const ImageInput& input, const ColorChannels& color) {
    using Transfer = ColorEncoding::Transfer;
    const OIIO::ImageSpec& spec = input.spec();
    const auto own = image.text.find("skinglow:encoding");
    ColorEncoding encoding;
    if (own != image.text.end()) {
        encoding.transfer = own->second == "linear" ? Transfer::linear : Transfer::srgb;
        return encoding;
    }
    if (auto png = read_png_encoding(input.path())) return *png;
    const OIIO::TypeDesc type = spec.channelformat(color.rgb[0]);
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    const bool names_srgb = OIIO::Strutil::iequals(space, "sRGB");
    if (OIIO::Strutil::iequals(space, "linear") || (type.is_floating_point() && !names_srgb)) {
        encoding.transfer = Transfer::linear;
    } else if (const float gamma = spec.get_float_attribute("oiio:Gamma", 0.0F);
               OIIO::Strutil::istarts_with(space, "Gamma") && gamma > 0.0F && std::isfinite(gamma)) {
        encoding.transfer = Transfer::gamma;
        encoding.gamma = gamma;
    }
    Chromaticities values{};
    std::array<float, 8> floats{};
    if (spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), floats.data())) {
        std::copy(floats.begin(), floats.end(), values.begin());
        encoding.chromaticities = values;
    }
    const std::string interop = spec.get_string_attribute("colorInteropID");
    if (!interop.empty() && interop != "lin_rec709_scene" && !encoding.chromaticities) {
        encoding.note = "its color space \"" + interop + "\" is not read; it is taken as Rec.709";
    }
    if (spec.find_attribute("ICCProfile") != nullptr) {
        const std::string name = spec.get_string_attribute("ICCProfile:profile_description");
        if (name.find("sRGB") == std::string::npos) {
            encoding.note = "its ICC profile \"" + name + "\" is not read; it is taken as Rec.709";
        }
    }
    return encoding;
}

/// Makes values linear Rec.709 in place.
void decode(LinearImage& image, const ColorEncoding& encoding) {
    if (encoding.transfer == ColorEncoding::Transfer::gamma) {
        for (float& value : image.rgb) {
            value = static_cast<float>(std::pow(std::max(value, 0.0F), encoding.gamma));
        }
        image.notes.push_back("its values were decoded from gamma " + std::to_string(encoding.gamma) +
                              " to linear light");
    } else if (encoding.transfer == ColorEncoding::Transfer::srgb) {
        for (float& value : image.rgb) value = static_cast<float>(srgb_to_linear(value));
        image.notes.emplace_back("its values were decoded from sRGB to linear light");
    }
    if (!encoding.note.empty()) image.notes.push_back(encoding.note);
    if (image.gray || !encoding.chromaticities || is_rec709(*encoding.chromaticities)) return;
    const auto matrix = to_rec709(*encoding.chromaticities);
    if (!matrix) {
        image.notes.emplace_back(
            "its primaries span no colors and are not read; they are taken as Rec.709's");
        return;
    }
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        const glm::dvec3 color = *matrix * glm::dvec3(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
        for (int k = 0; k < 3; ++k) image.rgb[i + static_cast<std::size_t>(k)] = static_cast<float>(color[k]);
    }
    image.notes.emplace_back("its colors were taken from its own primaries to Rec.709");
}

/// Whole numbers in an EXR are indices and counts.
void check_number_type(const ImageInput& input, const ColorChannels& color) {
    if (input.format() != "openexr") return;
    for (const int channel : color.rgb) {
        if (input.spec().channelformat(channel).is_floating_point()) continue;
        refuse_file(input.path(),
                    "holds whole numbers, not light, in its channel " +
                        input.spec().channelnames[static_cast<std::size_t>(channel)],
                    "write its colors as half or float");
    }
}

/// Values of the data window in the whole picture, 0 around it.
std::vector<float> in_full_window(std::vector<float>& values, OIIO::ImageSpec window, int channels) {
    window.nchannels = channels;
    window.set_format(OIIO::TypeFloat);
    const OIIO::ImageBuf full =
        OIIO::ImageBufAlgo::crop(OIIO::ImageBuf(window, values.data()), window.roi_full());
    const auto* first = static_cast<const float*>(full.localpixels());
    return {first, first + full.spec().image_pixels() * static_cast<OIIO::imagesize_t>(channels)};
}

void fill_full_window(LinearImage& image, const OIIO::ImageSpec& spec) {
    if (spec.roi() == spec.roi_full()) return;
    if (image.alpha.empty()) image.alpha.assign(image.pixels(), 1.0F);
    image.rgb = in_full_window(image.rgb, spec, 3);
    image.alpha = in_full_window(image.alpha, spec, 1);
    image.width = spec.full_width;
    image.height = spec.full_height;
    image.notes.emplace_back("its data window was put into the whole picture, black around it");
}

}  // namespace

LinearImage read_image(const std::filesystem::path& path) {
    ImageInput input(path);
    const ColorChannels color = find_color(input);
    input.check_size();
    check_number_type(input, color);
    const OIIO::ImageSpec& spec = input.spec();
    LinearImage image;
    image.width = spec.width;
    image.height = spec.height;
    image.gray = color.rgb[0] == color.rgb[1];
    image.text = input.text();
    std::array<int, 4> wanted = {color.rgb[0], color.rgb[1], color.rgb[2],
                                 color.alpha.value_or(color.rgb[0])};
    const auto [low, high] = std::minmax_element(wanted.begin(), wanted.end());
    const int begin = *low;
    const int end = *high + 1;
    const std::vector<float> values = input.read_channels(begin, end);
    const auto stride = static_cast<std::size_t>(end - begin);
    image.rgb.resize(image.pixels() * 3);
    if (color.alpha) image.alpha.resize(image.pixels());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            image.rgb[3 * i + channel] =
                values[i * stride + static_cast<std::size_t>(wanted[channel] - begin)];
        }
        if (color.alpha) image.alpha[i] = values[i * stride + static_cast<std::size_t>(wanted[3] - begin)];
    }
    decode(image, encoding_of(image, input, color));
    if (!color.others.empty()) {
        std::string names;
        for (const std::string& name : color.others) names += (names.empty() ? "" : ", ") + name;
        image.notes.push_back("further layers are not read: " + names);
    }
    if (spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) {
        for (std::size_t i = 0; i < 3 * image.alpha.size(); ++i) image.rgb[i] *= image.alpha[i / 3];
    }
    fill_full_window(image, spec);
    if (std::any_of(image.rgb.begin(), image.rgb.end(), [](float value) { return !std::isfinite(value); })) {
        refuse_file(path, "holds a value whose linear light is beyond float32",
                    "write it anew with smaller values");
    }
    return image;
}

std::optional<RawChannels> read_raw_channels(const std::filesystem::path& path,
                                             const std::vector<std::string>& names) {
    ImageInput input(path);
    std::vector<int> found;
    for (const std::string& name : names) {
        const auto channel = find_channel(input.spec(), name);
        if (!channel) return std::nullopt;
        found.push_back(*channel);
    }
    RawChannels raw{input.spec().width, input.spec().height, {}, input.text()};
    for (const int channel : found) raw.channels.push_back(input.read_channels(channel, channel + 1));
    return raw;
}

}  // namespace skinglow::detail
