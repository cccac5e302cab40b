// A lookup table as CSV, EXR or PNG (LUT_EXTENSION), as a table and as a base: finite, and a CSV written reads back equal.

#include <cmath>

#include "file_target.h"
#include "files/lut_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::detail;
    using namespace skinglow::fuzz;
    const auto path = written("table" LUT_EXTENSION, data, size);
    reads(path, [&] {
        const LutTable table = read_lut(path).table;
        require(!table.colors.empty() && table.colors.size() <= max_lut_size, "a table has entries");
        for (const glm::dvec3& color : table.colors) require(is_finite(color), "colors are finite");
        const auto again = scratch_file("again.csv");
        write_lut(again, table);
        require(read_lut(again).table.colors == table.colors, "a table reads back equal");
    });
    if (path.extension() == ".csv") return 0;
    reads(path, [&] {
        const BaseLut base = read_base_lut(path).base;
        require(base.axis().max_thickness_mm() > 0 && std::isfinite(base.axis().max_thickness_mm()),
                "an axis has a length");
        for (const glm::dvec3& color : recolor(base, glm::dvec3(1.0)))
            require(is_finite(color), "colors are finite");
    });
    return 0;
}
