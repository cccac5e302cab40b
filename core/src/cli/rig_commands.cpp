#include <skinglow/spectrum.h>

#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/output_text.h"
#include "cli/rig_options.h"
#include "files/atomic_file.h"
#include "numerics/argument_check.h"

namespace skinglow::cli {
namespace {

using nlohmann::ordered_json;

struct RigArguments {
    RigOptions rig;
    bool json = false;   ///< of weights
    std::string output;  ///< of rig
};

/// What --json prints, and the table shows.
ordered_json report_of(const LightRig& rig) {
    const AttenuationCoefficients& k = rig.coefficients;
    const glm::dvec3 sum = light_weight(rig.lights, rig.point, k);
    const std::vector<glm::dvec3> weights = light_weights(rig.lights, rig.point, k);
    ordered_json lights = ordered_json::array();
    for (std::size_t i = 0; i < rig.lights.size(); ++i) {
        const Light& light = rig.lights[i];
        const bool on = is_on(light);
        const bool has_distance = on && light.kind() != LightKind::sun;
        const double distance = has_distance ? light_distance(light, rig.point) : 0.0;
        lights.push_back({{"name", light.name().empty() ? "lights[" + std::to_string(i) + "]" : light.name()},
                          {"kind", to_text(light.kind())},
                          {"on", on},
                          {"distance", has_distance ? ordered_json(distance) : ordered_json()},
                          {"attenuation", has_distance ? attenuation(distance, k)
                                          : on         ? 1.0
                                                       : 0.0},
                          {"weight", to_json(weights[i])},
                          {"share", luminance(sum) > 0.0 ? luminance(weights[i]) / luminance(sum) : 0.0}});
    }
    return {{"point", to_json(rig.point)},
            {"attenuation", {{"constant", k.constant}, {"linear", k.linear}, {"quadratic", k.quadratic}}},
            {"lights", lights},
            {"light_weight", to_json(sum)},
            {"blood_weight", to_json(rig.blood_weight)},
            {"weight", to_json(require_finite("B + L", rig.blood_weight + sum))}};
}

void print_text(const LightRig& rig, const ordered_json& report) {
    const AttenuationCoefficients& k = rig.coefficients;
    std::cout << "At " << to_text(rig.point) << ", attenuation 1 / (" << to_text(k.constant) << " + "
              << to_text(k.linear) << " d + " << to_text(k.quadratic)
              << " d^2), at most 1. Share: of the brightness of L.\n\n";
    std::vector<std::vector<std::string>> rows{
        {"light", "kind", "distance", "attenuation", "r", "g", "b", "share"}};
    const auto add = [&](std::vector<std::string> row, const ordered_json& color, const std::string& share) {
        for (const double channel : color) row.push_back(short_number(channel));
        row.push_back(share);
        rows.push_back(std::move(row));
    };
    for (const ordered_json& light : report["lights"]) {
        add({light["name"], light["kind"],
             light["distance"].is_null() ? "-" : short_number(light["distance"]),
             light["on"] ? short_number(light["attenuation"]) : "off"},
            light["weight"], short_number(100.0 * light["share"].get<double>()) + "%");
    }
    add({"L", "sum", "", ""}, report["light_weight"], "");
    add({"B", "blood", "", ""}, report["blood_weight"], "");
    add({"B + L", "", "", ""}, report["weight"], "");
    print_table(std::cout, std::move(rows));
}

void run_report(const RigArguments& options) {
    const LightRig rig = options.rig.read();
    const ordered_json report = report_of(rig);
    if (options.json) {
        print_json(report);
    } else {
        print_text(rig, report);
    }
}

}  // namespace

void add_weights_command(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("weights", "How much each light counts at a point (Eq. 2 and 3 of the paper)");
    const auto options = std::make_shared<RigArguments>();
    options->rig.add_to(*command, RigNeed::required);
    command->add_flag("--json", options->json, "Print JSON with every digit instead of a table");
    command->footer("Example: skinglow weights table1.json --point 0 0 0");
    command->callback([options] { run_report(*options); });
}

void add_rig_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "rig", "Write lights as a rig file: a studio light of Blender's, or a rig with numbers changed");
    auto options = std::make_shared<RigArguments>();
    options->rig.add_to(*command, RigNeed::required);
    command->add_option("-o,--output", options->output, "Rig file to write (JSON, docs/rig_format.md)")
        ->required();
    command->footer("Example: skinglow rig rim.sl --camera-rotation 90 0 35 -o rim.json");
    command->callback([options] {
        refuse_overwriting({options->output}, {options->rig.path()});
        const LightRig rig = options->rig.read();
        write_light_rig(options->output, rig);
        std::cout << options->output << ": " << rig.lights.size() << " lights\n";
    });
}

}  // namespace skinglow::cli
