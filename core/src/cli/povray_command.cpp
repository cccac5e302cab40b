#include <skinglow/povray.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/vec4.hpp>
#include <iostream>
#include <memory>
#include <numbers>
#include <set>
#include <stdexcept>
#include <variant>

#include "cli/commands.h"
#include "cli/mesh_options.h"
#include "cli/output_text.h"
#include "cli/rig_options.h"
#include "cli/table_options.h"
#include "files/atomic_file.h"
#include "geometry/smooth_normals.h"
#include "numerics/argument_check.h"

namespace skinglow::cli {
namespace {

struct PovrayArguments {
    RigOptions rig;
    MeshOptions mesh;
    TableOptions table;
    SkinOptions skin;
    std::string lut;
    std::string folder;
    std::string up;  ///< empty: as the mesh's format says
    std::uint32_t width = 512;
    std::uint32_t height = 512;
    double field_of_view = 40.0;
    double strength = 1.0;
    std::optional<std::array<double, 3>> surface;
};

/// Files of meshes are read without their normals; folds of skin are rounder than this, edges of boxes are not.
constexpr double sharp_edge = std::numbers::pi / 3.0;

bool is_spread(const Light& light) {
    const auto* area = std::get_if<AreaLight>(&light.shape());
    return area != nullptr && is_on(light) && area->spread < std::numbers::pi;
}

/// The mesh in the scene's axes: one with y up is turned as Blender's importers do.
TriangleMesh turn_upright(const TriangleMesh& mesh, bool y_up) {
    if (!y_up) return mesh;
    std::vector<glm::dvec3> vertices = mesh.vertices();
    for (glm::dvec3& vertex : vertices) vertex = {vertex.x, -vertex.z, vertex.y};
    return {std::move(vertices), mesh.triangles()};
}

/// A camera of this rotation that sees the whole mesh.
PovrayCamera frame(const TriangleMesh& mesh, const PovrayArguments& options) {
    PovrayCamera camera;
    camera.width = options.width;
    camera.height = options.height;
    if (!(options.field_of_view > 0.0 && options.field_of_view < 180.0))
        refuse_argument("--field-of-view", to_text(options.field_of_view), "degrees above 0 and below 180");
    const double angle = options.field_of_view * std::numbers::pi / 180.0;
    if (options.width == 0 || options.height == 0)
        refuse_argument(options.width == 0 ? "--width" : "--height", "0", "1 to 65535 pixels");
    set_field_of_view(camera, angle);
    const Box box = box_of(mesh.vertices());
    const double narrow =
        std::tan(angle / 2.0) * std::min(1.0, double(options.height) / double(options.width));
    const glm::dmat3 axes = options.rig.camera();
    const glm::dvec3 eye = box.center() + axes[2] * (box.radius() / std::sin(std::atan(narrow)));
    camera.matrix_world = glm::dmat4(glm::dvec4(axes[0], 0.0), glm::dvec4(axes[1], 0.0),
                                     glm::dvec4(axes[2], 0.0), glm::dvec4(eye, 1.0));
    return camera;
}

/// The glow from a table that was made before: it goes among the scene's pictures as it is. Of mode physical it holds
/// radiant exitance, M(d) E, of which skin shows 1 / pi.
PovrayLut use_table(const PovrayArguments& options, std::map<std::string, std::string>& pictures) {
    if (options.table.any_used() || options.skin.any_used()) {
        throw std::invalid_argument(
            "--lut brings its own table: leave out --mode, --base, --size, --max-thickness and the skin's");
    }
    options.rig.require_used(RigNumbers::none, "--lut brings its own table");
    const LutFile file = read_lut(options.lut);
    for (const std::string& note : file.notes) tell(options.lut, note);
    PovrayLut lut;
    lut.axis = LutAxis(file.table.colors.size(), file.table.record.max_thickness_mm);
    lut.glow = PovrayGlow::image;
    lut.image = "lut.exr";
    if (file.table.record.mode) lut.mode = *file.table.record.mode;
    lut.strength = options.strength * (lut.mode == LutMode::physical ? std::numbers::inv_pi : 1.0);
    pictures[lut.image] = lut_exr_bytes(lut.image, file.table);
    return lut;
}

/// The glow that the macros compute for themselves from the base or the skin, and the lights.
PovrayLut compute_table(const PovrayArguments& options) {
    PovrayLut lut;
    lut.strength = options.strength;
    lut.mode = options.table.mode(options.skin);
    options.rig.require_used(lut.mode);
    if (lut.mode == LutMode::physical) {
        const BaseLut skin = options.table.solve_skin(options.skin).lut;
        lut.axis = skin.axis();
        lut.matrices.assign(skin.matrices().begin(), skin.matrices().end());
        return lut;
    }
    if (lut.mode == LutMode::existing) {
        if (options.table.has_base())
            throw std::invalid_argument("--mode existing has a fixed table: leave out --base");
        lut.axis = options.table.built_in_axis();
        return lut;
    }
    const BaseLut base = options.table.read_base();
    lut.axis = base.axis();
    lut.base = gray_entries(base);
    return lut;
}

/// All files that a scene may have. Of an earlier scene in the folder those go that this one has not.
const std::set<std::string> scene_files = {"camera.inc", "columns.inc", "lights.inc",
                                           "lut.exr",    "lut.inc",     "mesh.inc",
                                           "scene.ini",  "scene.pov",   "skinglow.inc"};

/// Nothing that is read may stand where a file of the scene will.
void check_folder(const PovrayArguments& options) {
    std::vector<std::filesystem::path> outputs;
    outputs.reserve(scene_files.size());
    for (const std::string& name : scene_files)
        outputs.push_back(std::filesystem::path(options.folder) / name);
    std::vector<std::filesystem::path> inputs = options.mesh.sources();
    inputs.insert(inputs.end(), {options.rig.path(), options.table.base_path(), options.lut});
    refuse_overwriting(outputs, inputs);
}

void run_povray(PovrayArguments& options) {
    const LightRig rig = options.rig.read();
    const TriangleMesh read = options.mesh.read();
    const TriangleMesh mesh =
        turn_upright(read, options.up.empty() ? options.mesh.has_y_up() : options.up == "y");
    check_folder(options);
    std::map<std::string, std::string> pictures;
    PovrayScene scene;
    scene.camera = frame(mesh, options);
    scene.lights = rig.lights;
    scene.lut = options.lut.empty() ? compute_table(options) : use_table(options, pictures);
    scene.lut.point = rig.point;
    scene.lut.coefficients = rig.coefficients;
    scene.lut.blood_weight = rig.blood_weight;
    scene.mesh.geometry = mesh;
    if (const auto& rgb = options.surface) {
        scene.surface = PovraySurface{{(*rgb)[0], (*rgb)[1], (*rgb)[2]}, ""};
        scene.mesh.corner_normals = smooth_normals(mesh, sharp_edge);
        if (std::any_of(rig.lights.begin(), rig.lights.end(), is_spread)) {
            tell(
                options.rig.path(),
                "the spread of an area light is a cone in POV-Ray: light on the surface is up to 15 % of the "
                "brightest off");
        }
    }
    const double thickest = scene.lut.axis.max_thickness_mm();
    std::size_t thin = 0;
    for (const double thickness : options.mesh.measure(mesh)) {
        if (thickness < thickest) ++thin;
        scene.mesh.lut_u.push_back(scene.lut.axis.texel_scale() * thickness + scene.lut.axis.texel_offset());
    }
    auto files = povray_files(scene);
    const std::size_t texts = files.size();
    files.merge(pictures);
    replace_folder(options.folder, files, scene_files);
    std::cout << options.folder << ": " << texts << " files, " << mesh.triangles().size() << " triangles, "
              << short_number(100.0 * static_cast<double>(thin) / static_cast<double>(mesh.vertices().size()))
              << " % of the vertices thinner than the table's " << to_text(thickest) << " mm"
              << (thin == 0 ? " (nothing glows: is --unit right?)" : "") << "; render with: cd "
              << shell_word(options.folder) << " && povray scene.ini\n";
}

}  // namespace

void add_povray_command(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("povray", "Write a POV-Ray scene of a mesh that glows by the rig's lights");
    const auto options = std::make_shared<PovrayArguments>();
    options->rig.add_to(*command, RigNeed::with_camera);
    options->mesh.add_to(*command, "--mesh");
    options->table.add_to(*command);
    options->skin.add_to(*command);
    add_option(*command, "--lut", options->lut, "FILE",
               "A table of skinglow lut; else the scene computes its own by the macros");
    add_option(*command, "-o,--output", options->folder, "DIR",
               "Folder for the scene's files; made if missing")
        .required();
    command
        ->add_option(
            "--up", options->up,
            "The mesh file's axis that points up; else y for glTF and GLB, whose format says so, and z")
        ->check(CLI::IsMember({"y", "z"}));
    add_option(*command, "--width", options->width, "PIXELS", "Of the picture");
    add_option(*command, "--height", options->height, "PIXELS", "Of the picture");
    add_option(*command, "--field-of-view", options->field_of_view, "DEGREES", "Angle that the width covers");
    add_option(*command, "--strength", options->strength, "X", "Of the glow");
    add_option(*command, "--surface", options->surface, "R G B",
               "Also a matt surface of this color, lit by the lights; smooth where faces meet at less than "
               "60 degrees");
    command->footer(
        "Example: skinglow povray table1.json --mesh head.obj --unit 100 --group body --up y -o scene\n"
        "Example: skinglow povray table1.json --mesh head.obj --mode physical --skin ear -o scene");
    command->callback([options] { run_povray(*options); });
}

}  // namespace skinglow::cli
