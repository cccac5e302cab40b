#include <skinglow/spectrum.h>

#include <iostream>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/output_text.h"
#include "cli/rig_options.h"
#include "numerics/argument_check.h"

namespace skinglow::cli {
namespace {

struct Options {
    RigOptions rig;
    bool json = false;
};

/// One row of the table.
struct LightShare {
    std::string name;
    bool on = false;
    std::optional<double> distance;  // a sun has none, and that of a light that is off does not matter
    double attenuation = 0.0;
    glm::dvec3 weight{0.0};
    double share = 0.0;  // of the brightness of L; 0 where L is black
};

std::vector<LightShare> light_shares(const LightRig& rig, const glm::dvec3& sum) {
    const std::vector<glm::dvec3> weights = light_weights(rig.lights, rig.point, rig.coefficients);
    std::vector<LightShare> shares;
    for (std::size_t i = 0; i < rig.lights.size(); ++i) {
        const Light& light = rig.lights[i];
        LightShare row{light.name().empty() ? "lights[" + std::to_string(i) + "]" : light.name(),
                       is_on(light),
                       {},
                       0.0,
                       weights[i],
                       0.0};
        if (row.on) {
            const double distance = light_distance(light, rig.point);
            if (light.kind() != LightKind::sun) row.distance = distance;
            row.attenuation = light.kind() == LightKind::sun ? 1.0 : attenuation(distance, rig.coefficients);
        }
        if (luminance(sum) > 0.0) row.share = luminance(weights[i]) / luminance(sum);
        shares.push_back(row);
    }
    return shares;
}

void print_text(const LightRig& rig, const std::vector<LightShare>& shares, const glm::dvec3& sum) {
    const AttenuationCoefficients& k = rig.coefficients;
    std::cout << "At " << to_text(rig.point) << ", attenuation 1 / (" << to_text(k.constant) << " + "
              << to_text(k.linear) << " d + " << to_text(k.quadratic)
              << " d^2), at most 1. Share: of the brightness of L.\n\n";
    std::vector<std::vector<std::string>> rows{
        {"light", "kind", "distance", "attenuation", "r", "g", "b", "share"}};
    const auto add = [&](const std::string& name, const std::string& kind, const std::string& distance,
                         const std::string& attenuation_text, const glm::dvec3& color,
                         const std::string& share) {
        rows.push_back({name, kind, distance, attenuation_text, short_number(color.r), short_number(color.g),
                        short_number(color.b), share});
    };
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const LightShare& row = shares[i];
        add(row.name, std::string(to_text(rig.lights[i].kind())),
            row.distance ? short_number(*row.distance) : "-", row.on ? short_number(row.attenuation) : "off",
            row.weight, short_number(row.share * 100.0) + "%");
    }
    add("L", "sum", "", "", sum, "");
    add("B", "blood", "", "", rig.blood_weight, "");
    add("B + L", "", "", "", require_finite("B + L", rig.blood_weight + sum), "");
    print_table(std::cout, rows);
}

void print_as_json(const LightRig& rig, const std::vector<LightShare>& shares, const glm::dvec3& sum) {
    nlohmann::ordered_json object;
    object["point"] = to_json(rig.point);
    object["attenuation"] = {{"constant", rig.coefficients.constant},
                             {"linear", rig.coefficients.linear},
                             {"quadratic", rig.coefficients.quadratic}};
    object["lights"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const LightShare& row = shares[i];
        nlohmann::ordered_json light;
        light["name"] = row.name;
        light["kind"] = to_text(rig.lights[i].kind());
        light["on"] = row.on;
        light["distance"] = row.distance ? nlohmann::ordered_json(*row.distance) : nlohmann::ordered_json();
        light["attenuation"] = row.attenuation;
        light["weight"] = to_json(row.weight);
        light["share"] = row.share;
        object["lights"].push_back(light);
    }
    object["light_weight"] = to_json(sum);
    object["blood_weight"] = to_json(rig.blood_weight);
    object["weight"] = to_json(require_finite("B + L", rig.blood_weight + sum));
    print_json(object);
}

void run(const Options& options) {
    const LightRig rig = options.rig.read();
    const glm::dvec3 sum = light_weight(rig.lights, rig.point, rig.coefficients);
    const std::vector<LightShare> shares = light_shares(rig, sum);
    if (options.json) {
        print_as_json(rig, shares, sum);
    } else {
        print_text(rig, shares, sum);
    }
}

}  // namespace

void add_weights_command(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("weights", "How much each light counts at a point (Eq. 2 and 3 of the paper)");
    const auto options = std::make_shared<Options>();
    options->rig.add_to(*command, RigNeed::required);
    command->add_flag("--json", options->json, "Print JSON with every digit instead of a table");
    command->footer("Example: skinglow weights table1.json --point 0 0 0");
    command->callback([options] { run(*options); });
}

}  // namespace skinglow::cli
