#pragma once

#include <pybind11/pybind11.h>

#include <functional>

namespace skinglow {

/// Asks Python whether to go on: an interrupt from the keyboard counts, with and without a function of the
/// caller's. Called without the interpreter's lock, which the work itself does not need. `progress` has to outlive
/// what is returned.
inline std::function<bool(double)> ask_python(const pybind11::object& progress) {
    return [&progress](double done) {
        const pybind11::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
        if (progress.is_none()) return true;
        const int go_on = PyObject_IsTrue(progress(done).ptr());
        if (go_on < 0) throw pybind11::error_already_set();
        return go_on != 0;
    };
}

}  // namespace skinglow
