#include "rig_files/studio_light.h"

#include <glm/gtc/quaternion.hpp>
#include <map>
#include <string_view>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"
#include "rig_files/parse_number.h"

namespace skinglow::detail {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 20U;  // a real one has 2 kB
constexpr int light_count = 4;
constexpr const char* remedy = "give a studio light (*.sl) as Blender writes it";

/// The numbers of the file by key.
class StudioLightText {
  public:
    explicit StudioLightText(const std::filesystem::path& path) : path_(path) {
        const std::string content = read_whole_file(path, max_bytes);
        std::string_view rest = content;
        for (std::size_t line = 1; !rest.empty(); ++line) {
            take_line(take_until(rest, '\n'), line);
        }
        if (const double version = number("version"); version != 1.0) {
            refuse_file(path, "is " + to_text(version), "version 1 is read", "key version");
        }
    }

    double number(const std::string& key) const {
        const auto found = numbers_.find(key);
        if (found == numbers_.end()) refuse_file(path_, "is missing", remedy, "key " + key);
        return found->second;
    }

    glm::dvec3 vector(const std::string& key) const {
        return {number(key + ".x"), number(key + ".y"), number(key + ".z")};
    }

    glm::dvec3 color(const std::string& key) const {
        const glm::dvec3 value = vector(key);
        for (int i = 0; i < 3; ++i) {
            if (value[i] < 0.0)
                refuse_file(path_, "is " + to_text(value), "colors are 0 or more", "key " + key);
        }
        return value;
    }

  private:
    void take_line(std::string_view line, std::size_t line_number) {
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
        if (line.empty()) return;
        const std::string where = "line " + std::to_string(line_number);
        const std::string key(take_until(line, ' '));
        const auto value = parse_number(line);
        if (!value) refuse_file(path_, "is no key with a finite number", remedy, where);
        if (!numbers_.emplace(key, *value).second)
            refuse_file(path_, "names " + key + " a second time", remedy, where);
    }

    const std::filesystem::path& path_;
    std::map<std::string, double> numbers_;
};

}  // namespace

glm::dmat3 camera_axes(const glm::dvec3& euler_xyz) {
    require_finite("camera rotation", euler_xyz);
    // About X first, then Y, then Z; a camera of rotation 0 looks along -Z with +Y up.
    return glm::mat3_cast(glm::dquat(euler_xyz));
}

StudioLight read_studio_light(const std::filesystem::path& path, const glm::dmat3& camera) {
    if (!is_orthogonal(camera, 1e-6)) {
        refuse_argument("camera", to_text(camera[0]) + to_text(camera[1]) + to_text(camera[2]),
                        "three perpendicular axes of length 1");
    }
    const StudioLightText text(path);
    StudioLight studio;
    if (text.color("light_ambient") != glm::dvec3(0.0)) {
        studio.notes.emplace_back("its ambient light was left out: it comes from no light");
    }
    bool soft = false;
    for (int i = 0; i < light_count; ++i) {
        const std::string name = "light[" + std::to_string(i) + "]";
        const glm::dvec3 color = text.color(name + ".col");
        const glm::dvec3 towards = text.vector(name + ".vec");
        const double flag = text.number(name + ".flag");
        const double smooth = text.number(name + ".smooth");
        if (flag == 0.0) continue;
        if (towards == glm::dvec3(0.0))
            refuse_file(path, "has length 0 and the light is on", remedy, "key " + name + ".vec");
        soft = soft || smooth != 0.0;
        studio.lights.emplace_back(LightSettings{.shape = SunLight{},
                                                 .color = color,
                                                 .direction = -(camera * towards),
                                                 .power = studio_light_power,
                                                 .name = name});
    }
    if (soft)
        studio.notes.emplace_back(
            "its lights' smooth (light that wraps around) was left out: suns have none");
    return studio;
}

}  // namespace skinglow::detail
