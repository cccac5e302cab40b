#include "cli/rig_options.h"

#include <numbers>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/output_text.h"
#include "rig_files/file_error.h"
#include "rig_files/studio_light.h"

namespace skinglow::cli {
namespace {

glm::dvec3 to_vector(const std::array<double, 3>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

void RigOptions::add_to(CLI::App& command, RigNeed need) {
    need_ = need;
    command.add_option("RIG", rig_path_, "Lights: a rig file (JSON) or a studio light of Blender's (*.sl)")
        ->required(need != RigNeed::optional);
    add_option(command, "--point", point_, "X Y Z", "Where on the skin, scene units; else the rig's");
    add_option(command, "--coefficients", coefficients_, "KC KL KQ",
               "Constant, linear and quadratic of the attenuation; else the rig's");
    add_option(command, "--blood", blood_, "R G B", "Blood weight B; else the rig's");
    const std::string whose = need == RigNeed::with_camera
                                  ? "Of the camera, on which the lights of *.sl hang"
                                  : "For *.sl: of the camera that the lights hang on";
    add_option(command, "--camera-rotation", camera_degrees_, "X Y Z",
               whose + ", XYZ in degrees; else 90 0 0, Blender's front view");
}

void RigOptions::require_used(RigNumbers used, const std::string& why) const {
    const auto refuse = [&](bool given, const char* name) {
        if (given) throw std::invalid_argument(why + ", which " + name + " would not change: leave it out");
    };
    if (used == RigNumbers::all) return;
    refuse(coefficients_.has_value(), "--coefficients");
    refuse(blood_.has_value(), "--blood");
    if (used == RigNumbers::none) refuse(point_.has_value(), "--point");
}

void RigOptions::require_used(LutMode mode) const {
    if (mode == LutMode::physical) require_used(RigNumbers::point, "--mode physical is light in W/m^2");
    if (mode == LutMode::existing) require_used(RigNumbers::none, "--mode existing has a fixed table");
}

glm::dmat3 RigOptions::camera() const {
    if (!camera_degrees_) return front_view;
    return camera_axes(to_vector(*camera_degrees_) * (std::numbers::pi / 180.0));
}

LightRig RigOptions::read() const {
    LightRig rig;
    if (small_extension(rig_path_) == ".sl") {
        StudioLight studio = read_studio_light(rig_path_, camera());
        for (const std::string& note : studio.notes) tell(rig_path_, note);
        rig.lights = std::move(studio.lights);
    } else {
        if (camera_degrees_ && need_ != RigNeed::with_camera) {
            throw std::invalid_argument("--camera-rotation is for *.sl files; a rig file has world axes");
        }
        rig = read_light_rig(rig_path_);
    }
    if (point_) rig.point = to_vector(*point_);
    if (coefficients_) rig.coefficients = {(*coefficients_)[0], (*coefficients_)[1], (*coefficients_)[2]};
    if (blood_) rig.blood_weight = to_vector(*blood_);
    validate(rig);
    return rig;
}

}  // namespace skinglow::cli
