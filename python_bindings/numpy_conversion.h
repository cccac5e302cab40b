#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <skinglow/rig.h>

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// From numpy to the core's types and back. Shapes are checked here, values by the core.
namespace skinglow::numpy {

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// "(2, 3)", as numpy writes it.
std::string shape_text(const pybind11::array& array);

/// Any array-like of real numbers as contiguous doubles; throws ValueError naming the argument on anything
/// else, text and complex numbers included.
Array to_array(pybind11::handle value, std::string_view name);

using FloatArray = pybind11::array_t<float, pybind11::array::c_style>;

/// The same in single precision: an array of it as it is, not copied. What is beyond it becomes infinite.
FloatArray to_floats(pybind11::handle value, std::string_view name);

/// One real number; throws ValueError on anything else, where a cast of pybind11's throws RuntimeError.
double to_number(pybind11::handle value, std::string_view name);

/// How many, or which: pybind11 itself says of a negative one, where it wants none, that its type is wrong, and not
/// which argument it is. Throws ValueError.
std::size_t to_count(std::int64_t given, std::string_view name);

/// Three numbers.
glm::dvec3 to_vec3(pybind11::handle value, std::string_view name);

/// (n, 3).
std::vector<glm::dvec3> to_vec3s(pybind11::handle value, std::string_view name);

/// (4, 4), by rows, as a matrix on column vectors.
glm::dmat4 to_matrix4(pybind11::handle value, std::string_view name);

/// A PreparedRig as it is, or one made, without the GIL, from a sequence of Light; TypeError otherwise.
PreparedRig to_rig(pybind11::handle lights);

/// Hands the vector's own memory to numpy, as (n, 3), without a copy.
pybind11::array from_vec3s(std::vector<glm::dvec3>&& rows);
pybind11::array from_vec3(const glm::dvec3& value);
pybind11::array from_doubles(std::vector<double>&& values);

/// A read-only (n, 3, 3) view, [entry, row, column], of matrices that `owner` keeps alive.
pybind11::array view_of_matrices(std::span<const glm::dmat3> matrices, pybind11::handle owner);

/// What `work`, which touches no Python object, returns; other threads of Python run meanwhile.
template <typename Work>
auto without_gil(const Work& work) {
    const pybind11::gil_scoped_release release;
    return work();
}

}  // namespace skinglow::numpy
