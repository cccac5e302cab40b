#include <iostream>
#include <memory>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/output_text.h"
#include "files/atomic_file.h"
#include "files/image_compare.h"
#include "numerics/argument_check.h"

namespace skinglow::cli {
namespace {

struct CompareArguments {
    std::string first;
    std::string second;
    std::string heat_map;
    std::string mask;
    std::string side_by_side;
    bool ignore_edges = false;
    bool ignore_background = false;
    double peak = 1.0;
    std::optional<double> scale;
    std::optional<double> max_rms;
    bool json = false;
};

constexpr std::array<const char*, 3> channel_names = {"red", "green", "blue"};

nlohmann::ordered_json difference_json(const ImageDifference& difference) {
    nlohmann::ordered_json object{{"rms", difference.rms}, {"max", difference.max}};
    object["psnr_db"] = difference.psnr ? nlohmann::ordered_json(*difference.psnr) : nlohmann::ordered_json();
    return object;
}

void print_as_json(const ImageComparison& comparison, std::optional<double> heat_map_white) {
    nlohmann::ordered_json object = difference_json(comparison.total);
    for (std::size_t i = 0; i < 3; ++i) object[channel_names[i]] = difference_json(comparison.channel[i]);
    object["width"] = comparison.width;
    object["height"] = comparison.height;
    object["compared_pixels"] = comparison.compared_pixels;
    object["left_out_pixels"] = comparison.left_out_pixels;
    object["background_pixels"] = comparison.background_pixels;
    object["worst_pixel"] = {comparison.worst_x, comparison.worst_y};
    for (const auto& [percent, value] : comparison.percentiles)
        object["percentiles"][short_number(percent)] = value;
    if (heat_map_white) object["heat_map_white"] = *heat_map_white;
    print_json(object);
}

void print_text(const ImageComparison& comparison, std::optional<double> heat_map_white) {
    std::vector<std::vector<std::string>> rows{{"channel", "", "RMS", "maximum", "PSNR dB"}};
    const auto add = [&](const std::string& name, const ImageDifference& difference) {
        rows.push_back({name, "", short_number(difference.rms), short_number(difference.max),
                        difference.psnr ? short_number(*difference.psnr) : "same"});
    };
    for (std::size_t i = 0; i < 3; ++i) add(channel_names[i], comparison.channel[i]);
    add("all", comparison.total);
    print_table(std::cout, rows);
    std::cout << comparison.compared_pixels << " pixels compared, " << comparison.left_out_pixels
              << " left out; the worst at (" << comparison.worst_x << ", " << comparison.worst_y << ")\n";
    std::cout << "largest difference of a channel in";
    for (const auto& [percent, value] : comparison.percentiles) {
        std::cout << (percent > comparison.percentiles.front().first ? ", " : " ") << short_number(percent)
                  << " % of them: " << short_number(value);
    }
    std::cout << '\n';
    if (heat_map_white)
        std::cout << "heat map: white is a difference of " << short_number(*heat_map_white) << " or more\n";
}

/// @return the exit code
int run_compare(const CompareArguments& options) {
    if (options.max_rms) require_not_negative("--max-rms", *options.max_rms);
    if (options.scale && options.heat_map.empty() && options.side_by_side.empty())
        throw std::invalid_argument(
            "--scale is of heat maps: give --heatmap or --side-by-side, or leave it out");
    refuse_overwriting({options.heat_map, options.side_by_side},
                       {options.first, options.second, options.mask});
    require_writable(options.heat_map, "a heat map", {".png"});
    require_writable(options.side_by_side, "a picture to look at", {".png"});
    CompareOptions how;
    how.peak = options.peak;
    how.ignore_edges = options.ignore_edges;
    how.ignore_background = options.ignore_background;
    if (!options.mask.empty()) how.mask = options.mask;
    const ImageComparison comparison = compare_images(options.first, options.second, how);
    for (const std::string& note : comparison.notes) std::cerr << "skinglow: file " << note << '\n';
    std::optional<double> white;
    if (!options.heat_map.empty()) white = write_heat_map(options.heat_map, comparison, options.scale);
    if (!options.side_by_side.empty()) {
        white = options.scale.value_or(heat_map_white(comparison));
        write_side_by_side(options.side_by_side, options.first, options.second, comparison,
                           require_positive("--scale", *white));
    }
    if (options.json) {
        print_as_json(comparison, white);
    } else {
        print_text(comparison, white);
    }
    if (!options.max_rms || comparison.total.rms <= *options.max_rms) return 0;
    std::cerr << "skinglow: RMS " << short_number(comparison.total.rms) << " is above --max-rms "
              << short_number(*options.max_rms) << '\n';
    return 1;
}

}  // namespace

void add_compare_command(CLI::App& program, int& exit_code) {
    CLI::App* command = program.add_subcommand("compare", "How far two images are apart, in linear light");
    const auto options = std::make_shared<CompareArguments>();
    command->add_option("A", options->first, "An image")->required();
    command->add_option("B", options->second, "Another of the same size")->required();
    add_option(*command, "--heatmap", options->heat_map, "PNG",
               "Write a picture of the difference: black none, white most");
    add_option(*command, "--scale", options->scale, "X",
               "Difference that heat maps show white; else the largest");
    add_option(*command, "--side-by-side", options->side_by_side, "PNG",
               "Write a picture of A, B and the heat map");
    add_option(*command, "--mask", options->mask, "IMAGE", "Compare only where this image is above 0");
    command->add_flag(
        "--ignore-edges", options->ignore_edges,
        "Leave out antialiased edges: pixels in whose 3 x 3 neighborhood alpha or mask changes");
    command->add_flag("--ignore-background", options->ignore_background,
                      "Leave out pixels where the alpha of both images is 0");
    add_option(*command, "--peak", options->peak, "X", "Value of white for PSNR");
    add_option(*command, "--max-rms", options->max_rms, "X",
               "Exit with 1 if the RMS over all channels is above it");
    command->add_flag("--json", options->json, "Print JSON with every digit instead of a table");
    command->footer(
        "Example: skinglow compare blender.exr povray.exr --ignore-edges --heatmap difference.png --max-rms "
        "0.0039\n"
        "Exit code: 0, and with --max-rms 1 if the images are too far apart; 2 on an error.");
    command->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace skinglow::cli
