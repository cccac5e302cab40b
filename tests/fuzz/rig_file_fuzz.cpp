// A rig file: read, written and read again equal, or refused by name, with the key or the line.

#include "file_target.h"
#include "rig_files/light_rig.h"

namespace {

bool are_same(const skinglow::Light& one, const skinglow::Light& other) {
    const skinglow::LightSettings &a = one.settings(), &b = other.settings();
    return a.shape == b.shape && a.color == b.color && a.position == b.position &&
           a.direction == b.direction && a.power == b.power && a.name == b.name && a.visible == b.visible;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow::detail;
    using namespace skinglow::fuzz;
    const auto path = written("rig.json", data, size);
    reads(path,
          [&] {
              const LightRig rig = read_light_rig(path);
              const auto again = scratch_file("again.json");
              write_light_rig(again, rig);
              const LightRig same = read_light_rig(again);
              require(same.name == rig.name && same.point == rig.point &&
                          same.blood_weight == rig.blood_weight && same.lights.size() == rig.lights.size(),
                      "a rig reads back equal");
              for (std::size_t i = 0; i < rig.lights.size(); ++i)
                  require(are_same(same.lights[i], rig.lights[i]), "a light reads back equal");
          },
          {": line ", ": key "});
    return 0;
}
