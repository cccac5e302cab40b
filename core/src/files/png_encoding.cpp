#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "files/color_encoding.h"
#include "files/number_bytes.h"
#include "files/png_chunks.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

using Transfer = ColorEncoding::Transfer;

constexpr Chromaticities rec2020 = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290};
constexpr Chromaticities display_p3 = {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290};

std::uint32_t big_word(const std::string& bytes, std::size_t at) {
    return static_cast<std::uint32_t>(load_number<std::uint32_t, true>(bytes.data() + at));
}

/// The chunks about color that stand before the pixels, by name.
std::map<std::string, std::string> color_chunks(const std::filesystem::path& path) {
    constexpr std::size_t most = 128;  // an ICC profile's name stands at its start
    constexpr std::array wanted = {"cICP", "iCCP", "sRGB", "gAMA", "cHRM"};
    std::map<std::string, std::string> found;
    PngChunks chunks(path);
    for (auto name = chunks.next(); name && *name != "IDAT" && *name != "IEND"; name = chunks.next()) {
        if (std::find(wanted.begin(), wanted.end(), *name) != wanted.end()) found[*name] = chunks.data(most);
    }
    return found;
}

/// Coding-independent code points: ITU-T H.273.
ColorEncoding read_cicp(const std::filesystem::path& path, const std::string& data) {
    constexpr const char* remedy = "write it as EXR, or as PNG in sRGB";
    static const std::map<int, std::pair<Transfer, double>> transfers = {{2, {Transfer::srgb, 1.0}},
                                                                         {4, {Transfer::gamma, 2.2}},
                                                                         {5, {Transfer::gamma, 2.8}},
                                                                         {8, {Transfer::linear, 1.0}},
                                                                         {13, {Transfer::srgb, 1.0}}};
    static const std::map<int, std::optional<Chromaticities>> primaries = {
        {1, std::nullopt}, {2, std::nullopt}, {9, rec2020}, {12, display_p3}};
    const int primaries_code = static_cast<unsigned char>(data[0]);
    const int transfer_code = static_cast<unsigned char>(data[1]);
    const auto transfer = transfers.find(transfer_code);
    if (transfer == transfers.end()) {
        const std::string name = transfer_code == 16 ? " (PQ)" : transfer_code == 18 ? " (HLG)" : "";
        refuse_file(path,
                    "is encoded by transfer function " + std::to_string(transfer_code) + " of H.273" + name +
                        ", which is not read",
                    remedy, "chunk cICP");
    }
    const auto found = primaries.find(primaries_code);
    if (found == primaries.end()) {
        refuse_file(path,
                    "has the primaries " + std::to_string(primaries_code) + " of H.273, which are not read",
                    remedy, "chunk cICP");
    }
    const auto [kind, gamma] = transfer->second;
    return {kind, gamma, found->second, {}};
}

}  // namespace

std::optional<ColorEncoding> read_png_encoding(const std::filesystem::path& path) {
    const auto chunks = color_chunks(path);
    const auto chunk = [&](const char* name, std::size_t size) -> const std::string* {
        const auto found = chunks.find(name);
        return found != chunks.end() && found->second.size() >= size ? &found->second : nullptr;
    };
    if (const auto* cicp = chunk("cICP", 4)) return read_cicp(path, *cicp);
    ColorEncoding encoding;
    if (const auto* profile = chunk("iCCP", 1)) {
        const std::string name = profile->substr(0, profile->find('\0'));
        if (name.find("sRGB") == std::string::npos)
            encoding.note = "its ICC profile \"" + name + "\" is not read; it is taken as sRGB";
        return encoding;
    }
    if (chunk("sRGB", 1) != nullptr) return encoding;
    const auto* gamma = chunk("gAMA", 4);
    const auto* chromaticities = chunk("cHRM", 32);
    if (chromaticities != nullptr) {
        constexpr std::array order = {6, 7, 0, 1, 2, 3, 4, 5};  // the file has white first
        Chromaticities values{};
        for (std::size_t i = 0; i < 8; ++i) {
            values[static_cast<std::size_t>(order[i])] = big_word(*chromaticities, 4 * i) / 100000.0;
        }
        encoding.chromaticities = values;
    }
    if (gamma != nullptr && big_word(*gamma, 0) > 0) {
        const double exponent = 100000.0 / big_word(*gamma, 0);
        encoding.transfer = std::abs(exponent - 1.0) < 0.01 ? Transfer::linear : Transfer::gamma;
        encoding.gamma = exponent;
    } else if (chromaticities == nullptr) {
        return std::nullopt;
    }
    return encoding;
}

}  // namespace skinglow::detail
