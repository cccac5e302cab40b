#include "files/image_io.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cmath>

#include "files/exr_header.h"
#include "files/image_file.h"
#include "files/png_chunks.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

constexpr const char* damaged_remedy = "the file is damaged or was not written to its end; make it anew";

/// OpenImageIO's messages may run over several lines and end in a newline; errors here are one line.
std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text.empty() ? "no reason given" : text;
}

}  // namespace

ImageInput::ImageInput(const std::filesystem::path& path) : path_(path) {
    // Its own message for a missing file speaks of formats.
    std::error_code error;
    if (!std::filesystem::exists(path, error)) refuse_file(path, "does not exist", "check the name");
    if (!std::filesystem::is_regular_file(path, error))
        refuse_file(path, "is not a file", "give the name of a file");
    check_png_is_whole(path);
    check_exr_header(path);
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);  // decoding must come before the multiplication by alpha
    input_ = OIIO::ImageInput::open(path.string(), &wish);
    if (!input_) {
        refuse_file(path, "cannot be read as an image (" + one_line(OIIO::geterror()) + ")",
                    "give an image that is whole, such as EXR, PNG, TIFF or JPEG");
    }
}

void ImageInput::check_size() const {
    const OIIO::ImageSpec& spec = input_->spec();
    const auto check = [&](int width, int height) {
        if (std::min(width, height) >= 1 && std::max(width, height) <= max_image_side &&
            std::int64_t{width} * height <= max_image_pixels)
            return;
        refuse_file(path_, "is " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
                    "at most " + std::to_string(max_image_side) + " either way and " +
                        std::to_string(max_image_pixels) + " in all are read; make it smaller");
    };
    check(spec.width, spec.height);
    check(spec.full_width, spec.full_height);
    if (spec.depth > 1 || spec.deep) refuse_file(path_, "is a volume or a deep image", "give a flat image");
}

bool ImageInput::go_to_part(int part) {
    if (!input_->seek_subimage(part, 0)) {
        input_->seek_subimage(part_, 0);
        OIIO::geterror();  // the end of the list is no error
        return false;
    }
    part_ = part;
    return true;
}

std::vector<float> ImageInput::read_channels(int begin, int end) {
    check_size();
    const OIIO::ImageSpec& layout = spec();
    const auto channels = static_cast<std::size_t>(end - begin);
    const auto width = static_cast<std::size_t>(layout.width);
    std::vector<float> values(channels * width * static_cast<std::size_t>(layout.height));
    if (!input_->read_image(part_, 0, begin, end, OIIO::TypeFloat, values.data())) {
        refuse_file(path_, "cannot be read to its end (" + one_line(input_->geterror()) + ")",
                    damaged_remedy);
    }
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
    if (bad != values.end()) {
        const auto pixel = static_cast<std::size_t>(bad - values.begin()) / channels;
        refuse_file(path_, "holds a value that is not a finite number",
                    "render or write it anew; every pixel must be finite",
                    "pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")");
    }
    return values;
}

std::map<std::string, std::string> ImageInput::text() const {
    std::map<std::string, std::string> found;
    for (const OIIO::ParamValue& attribute : spec().extra_attribs) {
        const std::string key = attribute.name().string();
        if (key.starts_with("skinglow:") && attribute.type() == OIIO::TypeString)
            found[key] = attribute.get_string();
    }
    return found;
}

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
