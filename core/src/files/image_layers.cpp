#include <algorithm>

#include "files/image_io.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

/// A layer of color or gray: its channels, and what it is called.
struct ImageLayer {
    std::string name;
    bool is_plain = false;  ///< its channels are R, G and B without a prefix
    ColorChannels channels;

    bool is_combined() const { return name == "Combined" || name.ends_with(".Combined"); }
};

/// Parts that are not looked into: the pages of a long document.
constexpr int max_pages = 1000;

std::string part_name(const OIIO::ImageSpec& spec, int part, const std::string& channels) {
    const std::string own = spec.get_string_attribute("oiio:subimagename");
    return own.empty() ? channels + " of part " + std::to_string(part + 1) : own;
}

std::optional<ImageLayer> layer_of(const OIIO::ImageSpec& spec, int part, const std::string& prefix) {
    const auto red = find_channel(spec, prefix + "R");
    const auto green = find_channel(spec, prefix + "G");
    const auto blue = find_channel(spec, prefix + "B");
    if (!red || !green || !blue) return std::nullopt;
    ImageLayer layer;
    layer.is_plain = prefix.empty();
    layer.name = prefix.empty() ? part_name(spec, part, "RGB") : prefix.substr(0, prefix.size() - 1);
    layer.channels = {part, {*red, *green, *blue}, find_channel(spec, prefix + "A"), {}};
    return layer;
}

void add_layers(const OIIO::ImageSpec& spec, int part, std::vector<ImageLayer>& colors,
                std::vector<ImageLayer>& grays) {
    if (spec.deep || spec.depth > 1) return;
    const std::size_t before = colors.size();
    for (const std::string& name : spec.channelnames) {
        if (name != "R" && !name.ends_with(".R")) continue;
        if (auto layer = layer_of(spec, part, name.substr(0, name.size() - 1)))
            colors.push_back(std::move(*layer));
    }
    if (colors.size() > before || spec.nchannels > 2) return;
    ImageLayer gray;
    gray.name = part_name(spec, part, spec.channelnames[0]);
    gray.channels = {part, {0, 0, 0}, spec.nchannels == 2 ? std::optional(1) : std::nullopt, {}};
    grays.push_back(std::move(gray));
}

/// The one layer that answers to `fits`; none where there is none or several do.
template <class Fits>
const ImageLayer* only(const std::vector<ImageLayer>& layers, const Fits& fits) {
    const auto found = std::find_if(layers.begin(), layers.end(), fits);
    if (found == layers.end() || std::count_if(layers.begin(), layers.end(), fits) > 1) return nullptr;
    return &*found;
}

std::string names_of(const std::vector<ImageLayer>& layers) {
    std::string names;
    for (const ImageLayer& layer : layers) names += (names.empty() ? "" : ", ") + layer.name;
    return names;
}

}  // namespace

std::optional<int> find_channel(const OIIO::ImageSpec& spec, std::string_view name) {
    for (int i = 0; i < spec.nchannels; ++i) {
        if (spec.channelnames[static_cast<std::size_t>(i)] == name) return i;
    }
    return std::nullopt;
}

ColorChannels find_color(ImageInput& input) {
    std::vector<ImageLayer> colors;
    std::vector<ImageLayer> grays;
    int parts = 0;
    do add_layers(input.spec(), parts++, colors, grays);
    while (parts < max_pages && input.go_to_part(parts));
    input.go_to_part(0);
    const std::vector<ImageLayer>& layers = colors.empty() ? grays : colors;
    if (layers.empty()) {
        refuse_file(input.path(),
                    "has no channels R, G and B, nor one alone (first: " + input.spec().channelnames[0] + ")",
                    "write it as a color or gray image");
    }
    const ImageLayer* chosen = only(layers, [](const ImageLayer&) { return true; });
    if (chosen == nullptr) chosen = only(layers, [](const ImageLayer& layer) { return layer.is_combined(); });
    if (chosen == nullptr) chosen = only(layers, [](const ImageLayer& layer) { return layer.is_plain; });
    if (chosen == nullptr) {
        const ImageLayer& first = layers.front();
        input.go_to_part(first.channels.part);
        refuse_file(input.path(),
                    "has " + std::to_string(layers.size()) + " layers of color: " + names_of(layers) +
                        " (such as " +
                        input.spec().channelnames[static_cast<std::size_t>(first.channels.rgb[0])] + ")",
                    "write the one you mean to a file of its own");
    }
    input.go_to_part(chosen->channels.part);
    ColorChannels found = chosen->channels;
    for (const ImageLayer& layer : layers) {
        if (&layer != chosen) found.others.push_back(layer.name);
    }
    return found;
}

}  // namespace skinglow::detail
