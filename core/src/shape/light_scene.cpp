#include "shape/light_scene.h"

#include <algorithm>
#include <utility>

#include "numerics/job.h"

namespace skinglow::detail {
namespace {

/// Irradiances at vertices that are kept, for memory's sake.
constexpr std::size_t max_kept = std::size_t{1} << 24U;
constexpr double work_of_traced = 0.005;

}  // namespace

LightScene::LightScene(std::shared_ptr<const ShapeData> of, PreparedRig lights,
                       const ShapeLightOptions& given)
    : shape(std::move(of)),
      rig(std::move(lights)),
      options(given),
      to_occluders("occluder_frame", given.occluder_frame) {
    if (given.environment != nullptr) environment = *given.environment;
    if (given.occluders != nullptr) occluders = *given.occluders;
    options.environment = nullptr;
    options.occluders = nullptr;
}

bool LightScene::has_same_shadows(const LightScene& other) const {
    const auto scene = [](const LightScene& of) { return of.occluders ? &of.occluders->scene() : nullptr; };
    return shape->solver == other.shape->solver && scene(*this) == scene(other) &&
           (!occluders || (options.excluded == other.options.excluded &&
                           options.occluder_frame == other.options.occluder_frame));
}

bool LightScene::has_same_flesh(const LightScene& other) const {
    const Lanes a = shape->on_the_way();
    const Lanes b = other.shape->on_the_way();
    return shape->solver == other.shape->solver &&
           (options.reentries == 0 || std::equal(std::begin(a.v), std::end(a.v), std::begin(b.v)));
}

bool LightScene::has_same_world(const LightScene& other) const {
    return environment && other.environment &&
           environment->coefficients() == other.environment->coefficients();
}

bool LightScene::has_same_color(std::size_t k, const LightScene& other, std::size_t j) const {
    return rig.data().prepared[k].strength() == other.rig.data().prepared[j].strength();
}

bool LightScene::may_shine(std::size_t light) const {
    const RigLight& one = rig.data().prepared[light];
    return rig.lights()[light].visible() && one.power != 0 && !one.light.dark();
}

bool LightScene::casts_shadows(std::size_t light) const {
    return std::find(options.shadowless.begin(), options.shadowless.end(), light) == options.shadowless.end();
}

double LightTracer::work() const {
    return work_of_traced * static_cast<double>(scene_->shape->vertices.size());
}

bool LightTracer::keeps_all() const {
    return scene_->rig.size() * scene_->shape->vertices.size() <= max_kept;
}

const VertexLight& LightTracer::vertex_light() {
    stop_if_asked();
    if (!vertex_light_) {
        const ShapeData& shape = *scene_->shape;
        const ShapeLightOptions& options = scene_->options;
        vertex_light_.emplace(
            shape.solver->surface(), shape.vertices, shape.solver->vertex_sites(), shape.options.unit_mm,
            shape.solver->wanted_vertices(options.reentries),
            ShadowOptions{scene_->occluders ? &*scene_->occluders : nullptr, options.excluded,
                          scene_->to_occluders, options.shadow_samples, shape.options.threads});
    }
    return *vertex_light_;
}

WhiteIrradiance LightTracer::traced(std::size_t light) {
    return vertex_light().of_light(scene_->rig.data().prepared[light].light, scene_->casts_shadows(light));
}

std::vector<glm::dvec3> LightTracer::traced_world() {
    const std::vector<glm::vec3> found = vertex_light().of_environment(*scene_->environment);
    return {found.begin(), found.end()};
}

}  // namespace skinglow::detail
