// SPDX-License-Identifier: Apache-2.0
// The module earthshine._core: Python bindings of session.h. The package beside it (earthshine/) is
// the public interface.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <future>

#include "base/error.h"
#include "python/session.h"

namespace py = pybind11;

namespace {

using namespace earthshine;  // NOLINT(google-build-using-namespace): one file of glue

// Runs the work on a separate thread without the interpreter's lock, and polls signals twenty times
// a second: Ctrl-C stops the work and is raised afterwards.
template <class Work>
auto run(Work work) {
  python::ask_to_stop(false);
  std::exception_ptr interrupt;
  std::future<decltype(work())> result;
  {
    const py::gil_scoped_release released;
    result = std::async(std::launch::async, std::move(work));
    while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
      const py::gil_scoped_acquire held;
      if (interrupt || PyErr_CheckSignals() == 0) continue;
      interrupt = std::make_exception_ptr(py::error_already_set());
      python::ask_to_stop(true);
    }
  }
  if (!interrupt) return result.get();
  python::ask_to_stop(false);
  try {
    (void)result.get();
  } catch (...) {  // error of a call that was asked to stop
  }
  std::rethrow_exception(interrupt);
}

// A view of numbers that `owner` keeps alive; read-only unless `writable`.
template <class Number>
py::array view(const std::vector<Number>& values, std::vector<py::ssize_t> shape,
               py::handle owner) {
  py::array array(py::dtype::of<Number>(), std::move(shape), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::dict layers(const base::Image& image, py::handle owner) {
  py::dict all;
  for (const base::Channel& channel : image.channels) {
    all[py::str(channel.name)] = view(channel.values, {image.height, image.width}, owner);
  }
  return all;
}

// Names from files may be invalid UTF-8.
py::object text(const std::string& bytes) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace"));
}

py::dict header_of(const base::ExrHeader& header) {
  py::dict all;
  for (const auto& [name, value] : header.text) {
    all[py::str(name)] = text(value);
  }
  for (const auto& [name, value] : header.numbers) all[py::str(name)] = value;
  return all;
}

using Plane = py::array_t<float, py::array::c_style | py::array::forcecast>;

// A frame from planes of one size, by channel.
std::shared_ptr<python::Frame> frame_of(const py::dict& planes, double fov_deg) {
  auto frame = std::make_shared<python::Frame>();
  frame->fov_deg = fov_deg;
  base::Image& image = frame->file.image;
  for (const auto& [name, values] : planes) {
    const auto plane = values.cast<Plane>();
    if (plane.ndim() != 2) throw py::value_error("each layer has the shape (rows, columns)");
    const int rows = static_cast<int>(plane.shape(0)), columns = static_cast<int>(plane.shape(1));
    if (!image.channels.empty() && (rows != image.height || columns != image.width)) {
      throw py::value_error("all layers have one shape");
    }
    image.height = rows;
    image.width = columns;
    std::vector<float>& own = image.add(name.cast<std::string>());
    std::copy(plane.data(), plane.data() + plane.size(), own.begin());
  }
  return frame;
}

void define_errors(py::module_& m) {
  static py::exception<base::Error> type(m, "Error", PyExc_Exception);
  type.attr("__module__") = "earthshine";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const base::Error& error) {
      const py::object value = py::handle(type)(error.what());
      const auto& [where, found, allowed, remedy] = error.parts();
      value.attr("blame") = error.blame() == base::Blame::Input ? "input" : "work";
      value.attr("file") = text(where.file);
      value.attr("line") = where.line;
      value.attr("column") = where.column;
      value.attr("found") = text(found);
      value.attr("allowed") = text(allowed);
      value.attr("remedy") = text(remedy);
      PyErr_SetObject(type.ptr(), value.ptr());
    }
  });
}

void define_frames(py::module_& m) {
  using python::Frame;
  py::class_<Frame, std::shared_ptr<Frame>>(m, "Frame")
      .def_property_readonly(
          "layers",
          [](const py::object& self) { return layers(self.cast<const Frame&>().file.image, self); })
      .def_property_readonly("header", [](const Frame& f) { return header_of(f.file.header); })
      .def_readonly("report", &Frame::report)
      .def_readonly("fov_deg", &Frame::fov_deg)
      .def_property_readonly("shape", [](const Frame& f) {
        return py::make_tuple(f.file.image.height, f.file.image.width);
      });
  m.def("frame_of", &frame_of);
  m.def("read_frame",
        [](const std::string& path) { return run([&] { return python::read_frame(path); }); });
  m.def("relight", [](const Frame& frame, const std::vector<std::string>& settings) {
    return run([&] { return python::relight(frame, settings); });
  });
  m.def("write_frame", [](const Frame& frame, const std::string& path) {
    run([&] { return python::write_frame(frame, path), 0; });
  });
}

void define_monitors(py::module_& m) {
  using python::Monitor;
  py::class_<Monitor, std::shared_ptr<Monitor>>(m, "Monitor")
      .def_property_readonly("pixels",
                             [](const py::object& self) {
                               const auto& result = self.cast<const Monitor&>().result;
                               std::vector<py::ssize_t> shape = {result.rows, result.columns};
                               if (result.channels > 1) shape.push_back(result.channels);
                               return view(result.pixels, std::move(shape), self);
                             })
      .def_property_readonly("viewed",
                             [](const py::object& self) {
                               return layers(self.cast<const Monitor&>().result.viewed, self);
                             })
      .def_property_readonly("signal",
                             [](const py::object& self) {
                               return layers(self.cast<const Monitor&>().result.signal, self);
                             })
      .def_property_readonly(
          "twin",
          [](const py::object& self) { return layers(self.cast<const Monitor&>().twin, self); })
      .def_readonly("report", &Monitor::report);
  m.def("degrade",
        [](const python::Frame& frame, const std::string& request, const Monitor* before) {
          return run([&] { return python::degrade_frame(frame, request, before); });
        });
  m.def("write_monitor", [](const Monitor& monitor, const std::string& path) {
    run([&] { return python::write_monitor(monitor, path), 0; });
  });
}

void define_light(py::module_& m) {
  using python::Light;
  const auto per_group = [](std::vector<float> Light::*values) {
    return [values](const py::object& self) {
      const auto& light = self.cast<const Light&>();
      return view(
          light.*values,
          {static_cast<py::ssize_t>(light.count), static_cast<py::ssize_t>(light.groups.size()), 3},
          self);
    };
  };
  const auto per_patch = [](auto values, py::ssize_t width) {
    return [values, width](const py::object& self) {
      const auto& light = self.cast<const Light&>();
      std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(light.count)};
      if (width > 1) shape.push_back(width);
      return view(light.*values, std::move(shape), self);
    };
  };
  py::class_<Light, std::shared_ptr<Light>>(m, "Light")
      .def_readonly("report", &Light::report)
      .def_readonly("groups", &Light::groups)
      .def_property_readonly("radiosity", per_group(&Light::radiosity))
      .def_property_readonly("direct", per_group(&Light::direct_lx))
      .def_property_readonly("indirect", per_group(&Light::indirect_lx))
      .def_property_readonly("area", per_patch(&Light::area_m2, 1))
      .def_property_readonly("centre", per_patch(&Light::centre_m, 3))
      .def_property_readonly("normal", per_patch(&Light::normal, 3))
      .def_property_readonly("object", per_patch(&Light::object, 1));
}

void define_sessions(py::module_& m) {
  using python::Session;
  py::class_<Session>(m, "Session")
      .def(py::init<std::string, std::optional<std::string>>())
      .def("set",
           [](Session& s, std::vector<std::string> overrides) {
             run([&] { return s.set(std::move(overrides)), 0; });
           })
      .def("describe", [](Session& s) { return run([&] { return s.describe(); }); })
      .def("work", &Session::work)
      .def("render",
           [](Session& s, const std::string& request,
              const std::shared_ptr<const python::Light>& light) {
             return run([&] { return s.render(request, light); });
           })
      .def("solve",
           [](Session& s, const std::string& request) {
             return run([&] { return s.solve(request); });
           })
      .def("write_light",
           [](Session& s, const python::Light& light, const std::string& path) {
             run([&] { return s.write_light(light, path), 0; });
           })
      .def("plan", [](Session& s,
                      const std::string& request) { return run([&] { return s.plan(request); }); })
      .def("form_factors", [](Session& s, const std::string& request) {
        return run([&] { return s.form_factors(request); });
      });
}

}  // namespace

// The macro generates functions with its own names.
PYBIND11_MODULE(_core, m) {
  m.doc() = "Earthshine's C++ side; use the package earthshine";
  python::be_a_guest();
  m.attr("version") = python::version();
  define_errors(m);
  define_frames(m);
  define_monitors(m);
  define_light(m);
  define_sessions(m);
  m.def("study",
        [](const std::string& request) { return run([&] { return python::run_study(request); }); });
}
