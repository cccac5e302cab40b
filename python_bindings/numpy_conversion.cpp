#include "numpy_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "numerics/argument_check.h"

namespace py = pybind11;

namespace skinglow::numpy {
namespace {

/// Moves the values to the heap, owned by a capsule that frees them with the last array that views them.
template <typename Value>
std::pair<Value*, py::capsule> keep(std::vector<Value>&& values) {
    auto kept = std::make_unique<std::vector<Value>>(std::move(values));
    Value* data = kept->data();
    py::capsule owner(kept.get(), [](void* pointer) { delete static_cast<std::vector<Value>*>(pointer); });
    kept.release();  // NOLINT(bugprone-unused-return-value): the capsule owns it from here
    return {data, owner};
}

/// Any array-like of real numbers as an array of its own type; throws ValueError naming the argument on anything else.
py::array real_numbers(py::handle value, std::string_view name) {
    const py::array given = py::array::ensure(value);
    if (!given) {
        PyErr_Clear();
        refuse_argument(name, py::repr(value).cast<std::string>(), "numbers");
    }
    // What numpy casts to float64 as of the "same kind". It would also read text, drop imaginary parts and
    // count days.
    if (std::string_view("biuf").find(given.dtype().kind()) == std::string_view::npos) {
        auto shown = py::reinterpret_steal<py::str>(PyObject_ASCII(value.ptr())).cast<std::string>();
        std::replace(shown.begin(), shown.end(), '\n', ' ');
        constexpr std::size_t max_shown = 80;
        if (shown.size() > max_shown) shown = shown.substr(0, max_shown) + "...";
        refuse_argument(name, shown + ", of type " + py::str(given.dtype()).cast<std::string>(),
                        "real numbers (a boolean, integer or float type)");
    }
    return given;
}

}  // namespace

std::string shape_text(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i) {
        text += std::to_string(array.shape(i)) + (array.ndim() == 1 ? "," : i + 1 < array.ndim() ? ", " : "");
    }
    return text + ")";
}

Array to_array(py::handle value, std::string_view name) {
    const py::array given = real_numbers(value, name);
    if (Array::check_(given)) return py::reinterpret_borrow<Array>(given);
    Array result = Array::ensure(given);
    if (!result) {
        // A long double beyond doubles is a warning of numpy's, which may be an error.
        PyErr_Clear();
        refuse_argument(name, "of type " + py::str(given.dtype()).cast<std::string>(),
                        "numbers that a double holds");
    }
    return result;
}

FloatArray to_floats(py::handle value, std::string_view name) {
    const py::array given = real_numbers(value, name);
    if (FloatArray::check_(given)) return py::reinterpret_borrow<FloatArray>(given);
    // Not by numpy, which warns of what is beyond single precision.
    const Array doubles = to_array(given, name);
    FloatArray result(std::vector<py::ssize_t>(doubles.shape(), doubles.shape() + doubles.ndim()));
    std::transform(doubles.data(), doubles.data() + doubles.size(), result.mutable_data(), [](double number) {
        constexpr double largest = std::numeric_limits<float>::max();
        constexpr float infinite = std::numeric_limits<float>::infinity();
        if (std::abs(number) > largest) return number > 0 ? infinite : -infinite;
        return static_cast<float>(number);
    });
    return result;
}

double to_number(py::handle value, std::string_view name) {
    const Array array = to_array(value, name);
    if (array.ndim() != 0) refuse_argument(name, "of shape " + shape_text(array), "one number");
    return *array.data();
}

std::size_t to_count(std::int64_t given, std::string_view name) {
    return static_cast<std::size_t>(require(name, given, given >= 0, "a whole number, 0 or more"));
}

glm::dvec3 to_vec3(py::handle value, std::string_view name) {
    const Array array = to_array(value, name);
    if (array.ndim() != 1 || array.shape(0) != 3) {
        refuse_argument(name, "of shape " + shape_text(array), "shape (3,)");
    }
    return {array.at(0), array.at(1), array.at(2)};
}

std::vector<glm::dvec3> to_vec3s(py::handle value, std::string_view name) {
    const Array array = to_array(value, name);
    if (array.ndim() != 2 || array.shape(1) != 3) {
        refuse_argument(name, "of shape " + shape_text(array), "shape (n, 3)");
    }
    const auto* rows = reinterpret_cast<const glm::dvec3*>(array.data());
    return {rows, rows + array.shape(0)};
}

glm::dmat4 to_matrix4(py::handle value, std::string_view name) {
    const Array array = to_array(value, name);
    if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
        refuse_argument(name, "of shape " + shape_text(array), "shape (4, 4)");
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) matrix[column][row] = array.at(row, column);
    }
    return matrix;
}

PreparedRig to_rig(py::handle lights) {
    if (py::isinstance<PreparedRig>(lights)) return lights.cast<const PreparedRig&>();
    if (!py::isinstance<py::sequence>(lights) || py::isinstance<py::str>(lights))
        throw py::type_error("lights is no list of Light or PreparedRig: " +
                             py::repr(lights).cast<std::string>());
    std::vector<Light> found;
    for (const py::handle light : lights) {
        if (!py::isinstance<Light>(light))
            throw py::type_error("lights[" + std::to_string(found.size()) +
                                 "] is no Light: " + py::repr(light).cast<std::string>());
        found.push_back(light.cast<const Light&>());
    }
    const py::gil_scoped_release release;
    return found;
}

py::array from_vec3s(std::vector<glm::dvec3>&& rows) {
    const auto count = static_cast<py::ssize_t>(rows.size());
    auto [data, owner] = keep(std::move(rows));
    return py::array_t<double>({count, py::ssize_t{3}}, reinterpret_cast<const double*>(data), owner);
}

py::array from_vec3(const glm::dvec3& value) {
    return py::array_t<double>(3, &value.x);
}

py::array from_doubles(std::vector<double>&& values) {
    const auto count = static_cast<py::ssize_t>(values.size());
    auto [data, owner] = keep(std::move(values));
    return py::array_t<double>({count}, data, owner);
}

py::array view_of_matrices(std::span<const glm::dmat3> matrices, py::handle owner) {
    constexpr py::ssize_t number = sizeof(double);
    // GLM keeps a matrix by columns: the strides turn it into rows without a copy.
    py::array_t<double> view({static_cast<py::ssize_t>(matrices.size()), py::ssize_t{3}, py::ssize_t{3}},
                             {9 * number, number, 3 * number},
                             reinterpret_cast<const double*>(matrices.data()), owner);
    py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return view;
}

}  // namespace skinglow::numpy
