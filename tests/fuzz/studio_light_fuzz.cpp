// One of Blender's studio lights: suns that are allowed, or a refusal.

#include "file_target.h"
#include "rig_files/studio_light.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::fuzz;
    const auto path = written("studio.sl", data, size);
    reads(path,
          [&] {
              const detail::StudioLight studio = detail::read_studio_light(path);
              require(studio.lights.size() <= 4, "a studio has four lights");
              for (const Light& light : studio.lights)
                  require(light.kind() == LightKind::sun, "a studio's lights are suns");
          },
          {": line ", ": key "});
    return 0;
}
