#include "mesh_arrays.h"

#include <pybind11/numpy.h>

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "numerics/argument_check.h"
#include "numpy_conversion.h"

namespace py = pybind11;

namespace skinglow::numpy {
namespace {

/// (m, 3) whole numbers that 32 bits hold; that they are below the number of vertices is for the mesh to
/// check.
std::vector<glm::uvec3> to_triangles(py::handle value, const std::string& name, std::size_t vertices) {
    // Through 64 bits, so that a negative index is refused and not wrapped.
    using IndexArray = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
    const py::array given = py::array::ensure(value);
    if (!given) {
        PyErr_Clear();
        refuse_argument(name, "not an array", "whole numbers of shape (m, 3)");
    }
    if (given.ndim() != 2 || given.shape(1) != 3)
        refuse_argument(name, "of shape " + shape_text(given), "shape (m, 3)");
    const char kind = given.dtype().kind();
    if (kind != 'i' && kind != 'u') {
        refuse_argument(name, "of type " + std::string(py::str(given.dtype())),
                        "whole numbers (an integer type)");
    }
    const IndexArray rows = IndexArray::ensure(given);
    std::vector<glm::uvec3> triangles(static_cast<std::size_t>(rows.shape(0)));
    const std::int64_t* row = rows.data();
    for (std::size_t i = 0; i < triangles.size(); ++i, row += 3) {
        for (int k = 0; k < 3; ++k) {
            if (row[k] < 0 || row[k] > std::numeric_limits<std::uint32_t>::max()) {
                refuse_argument(
                    name + "[" + std::to_string(i) + "]",
                    "(" + std::to_string(row[0]) + ", " + std::to_string(row[1]) + ", " +
                        std::to_string(row[2]) + ")",
                    "indices from 0 to below " + std::to_string(vertices) + ", the number of vertices");
            }
            triangles[i][k] = static_cast<std::uint32_t>(row[k]);
        }
    }
    return triangles;
}

}  // namespace

TriangleMesh to_mesh(py::handle vertices, py::handle triangles, const std::string& prefix) {
    std::vector<glm::dvec3> points = to_vec3s(vertices, prefix + "vertices");
    std::vector<glm::uvec3> corners = to_triangles(triangles, prefix + "triangles", points.size());
    return {std::move(points), std::move(corners), prefix};
}

}  // namespace skinglow::numpy
