#include <skinglow/lut.h>
#include <skinglow/rig.h>

#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/output_text.h"
#include "cli/rig_options.h"
#include "cli/table_options.h"
#include "files/atomic_file.h"
#include "files/lut_file.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::cli {
namespace {

struct LutArguments {
    RigOptions rig;
    TableOptions table;
    SkinOptions skin;
    std::optional<int> bits;
    std::optional<std::string> encoding;
    std::string output;
    std::string preview;
};

LutTable existing_table(const LutArguments& options) {
    if (options.rig.any_used() || options.table.has_base()) {
        throw std::invalid_argument(
            "--mode existing knows no lights and has a fixed table: leave out RIG, its options and --base");
    }
    const LutAxis axis = options.table.built_in_axis();
    return {six_gaussian_lookup(axis), {.max_thickness_mm = axis.max_thickness_mm()}};
}

LutTable paper_table(const LutArguments& options) {
    if (!options.rig.given()) throw std::invalid_argument("--mode paper needs lights: give a RIG file");
    const LightRig rig = options.rig.read();
    const BaseLut base = options.table.read_base();
    const glm::dvec3 lights = light_weight(rig.lights, rig.point, rig.coefficients);
    return {recolor(base, rig.blood_weight + lights),
            {.max_thickness_mm = base.axis().max_thickness_mm(),
             .light_weight = lights,
             .blood_weight = rig.blood_weight,
             .coefficients = rig.coefficients}};
}

/// The light that leaves the skin, M(d) E; without lights that of a white light that brings 1 W/m^2.
LutTable physical_table(const LutArguments& options) {
    glm::dvec3 irradiance(1.0);
    if (options.rig.given()) {
        options.rig.require_used(LutMode::physical);
        const LightRig rig = options.rig.read();
        irradiance = object_irradiance(rig.lights, rig.point);
    } else if (options.rig.any_used()) {
        throw std::invalid_argument("options of lights need a RIG file");
    }
    const SkinLut skin = options.table.solve_skin(options.skin);
    std::cout << "skin solved with " << skin.report.streams << " streams, error at most "
              << short_number(skin.report.estimated_error) << "; E " << to_text(irradiance)
              << " W/m^2; radiance is the table over pi\n";
    return {recolor(skin.lut, irradiance),
            {.max_thickness_mm = skin.lut.axis().max_thickness_mm(), .light_weight = irradiance}};
}

void run_lut(const LutArguments& options) {
    const LutMode mode = options.table.mode(options.skin);
    refuse_overwriting({options.output, options.preview}, {options.rig.path(), options.table.base_path()});
    require_writable(options.output, "a table", {".exr", ".png", ".csv"});
    require_writable(options.preview, "a preview", {".png"});
    if ((options.bits || options.encoding) && small_extension(options.output) != ".png") {
        throw std::invalid_argument(
            "--bits and --encoding are of a PNG, and " + options.output +
            " is none; .exr and .csv hold the numbers themselves: leave them out, or name it .png");
    }
    LutTable table = mode == LutMode::existing   ? existing_table(options)
                     : mode == LutMode::physical ? physical_table(options)
                                                 : paper_table(options);
    table.record.mode = mode;
    const PngOptions png{options.bits.value_or(8),
                         options.encoding == "linear" ? Encoding::linear : Encoding::srgb};
    const LutWriteReport report = write_lut(options.output, table, png);
    if (report.clamped_texels > 0) {
        tell(options.output, std::to_string(report.clamped_texels) + " of " +
                                 std::to_string(table.colors.size()) +
                                 " texels were clamped to 0..1; .exr and .csv keep them");
    }
    std::cout << options.output << ": mode " << to_text(mode) << ", " << table.colors.size()
              << " texels, 0 to " << to_text(table.record.max_thickness_mm) << " mm, "
              << to_text(table.colors.front()) << " at 0 mm\n";
    if (!options.preview.empty()) {
        const LutWriteReport shown = write_lut_preview(options.preview, table);
        std::cout << options.preview << ": a picture of it, sRGB, " << shown.clamped_texels
                  << " texels clamped\n";
    }
}

}  // namespace

void add_lut_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("lut", "Make a lookup table of light coming through skin");
    const auto options = std::make_shared<LutArguments>();
    options->rig.add_to(*command, RigNeed::optional);
    options->table.add_to(*command);
    options->skin.add_to(*command);
    command->add_option("--bits", options->bits, "Of a PNG")->check(CLI::IsMember({8, 16}))->default_str("8");
    command->add_option("--encoding", options->encoding, "Of a PNG")
        ->check(CLI::IsMember({"srgb", "linear"}))
        ->default_str("srgb");
    add_option(*command, "-o,--output", options->output, "FILE", "File to write: .exr, .png or .csv")
        .required();
    add_option(*command, "--preview", options->preview, "FILE", "Also write a PNG to look at, 512 x 64");
    command->footer(
        "Example: skinglow lut table1.json --max-thickness 8 -o ear.exr --preview ear.png\n"
        "Example: skinglow lut table1.json --mode physical --skin ear --melanin 0.1 -o ear.exr");
    command->callback([options] { run_lut(*options); });
}

}  // namespace skinglow::cli
