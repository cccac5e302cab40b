#include "files/image_output.h"

#include <OpenImageIO/filesystem.h>

#include <memory>

#include "rig_files/file_error.h"

namespace skinglow::detail {

std::string image_bytes(const std::filesystem::path& path, OIIO::ImageSpec spec,
                        const std::map<std::string, std::string>& text, const void* pixels) {
    for (const auto& [key, value] : text) spec.attribute(key, value);
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
    if (!output || !output->supports("ioproxy")) {
        refuse_file(path, "is of a format that cannot be written", "name it .exr or .png");
    }
    OIIO::Filesystem::IOVecOutput bytes;
    if (!output->set_ioproxy(&bytes) || !output->open(path.string(), spec) ||
        !output->write_image(spec.format, pixels) || !output->close()) {
        refuse_file(path, "cannot be written (" + output->geterror() + ")", "check the numbers in it");
    }
    output.reset();
    return {bytes.buffer().begin(), bytes.buffer().end()};
}

}  // namespace skinglow::detail
