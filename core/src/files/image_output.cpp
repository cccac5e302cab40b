#include "files/image_output.h"

#include <memory>

#include "files/atomic_file.h"
#include "rig_files/file_error.h"

namespace skinglow {

void write_image(const std::filesystem::path& path, OIIO::ImageSpec spec,
                 const std::map<std::string, std::string>& text, const void* pixels) {
    for (const auto& [key, value] : text) spec.attribute(key, value);
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(temporary.string());
        if (!output) refuse_file(path, "is of a format that cannot be written", "name it .exr or .png");
        if (!output->open(temporary.string(), spec) || !output->write_image(spec.format, pixels) ||
            !output->close()) {
            refuse_file(path, "cannot be written (" + output->geterror() + ")",
                        "check the disk and its free space");
        }
    });
}

}  // namespace skinglow
