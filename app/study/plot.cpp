// SPDX-License-Identifier: Apache-2.0
#include "app/study/plot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>

namespace earthshine::app {
namespace {

constexpr int panel_width_px = 640, panel_height_px = 420;

// Number of bytes of the character at `at`; 0 for invalid UTF-8.
std::size_t character_bytes(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned first = byte(at);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(at + k) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

std::string data_block(const std::string& name, const std::vector<PlotPoint>& points) {
  std::string text = "$" + name + " << EOD\n";
  for (const PlotPoint& p : points) {
    text += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", p.x, p.y, p.low, p.high);
  }
  return text + "EOD\n";
}

// Tick labels of a logarithmic axis: gnuplot places them at powers of ten only, and a short axis
// may contain none.
std::string tics(double low, double high) {
  const std::vector<std::vector<double>> steps = {
      {1}, {1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9}};
  constexpr std::size_t enough = 4;
  std::vector<std::string> words;
  for (const std::vector<double>& mantissas : steps) {
    words.clear();
    for (double decade = std::floor(std::log10(low)); decade <= std::log10(high); ++decade) {
      for (const double mantissa : mantissas) {
        const double value = mantissa * std::pow(10.0, decade);
        if (value >= low && value <= high) words.push_back(fmt::format("{:.6g}", value));
      }
    }
    if (words.size() >= enough) break;
  }
  return fmt::format("({})", fmt::join(words, ", "));
}

std::string panel_script(const PlotPanel& panel, std::size_t index) {
  std::string data, plots;
  double low_x = HUGE_VAL, high_x = 0.0, low_y = HUGE_VAL, high_y = 0.0;
  for (std::size_t k = 0; k < panel.curves.size(); ++k) {
    const PlotCurve& curve = panel.curves[k];
    if (curve.points.empty()) continue;
    for (const PlotPoint& p : curve.points) {
      low_x = std::min(low_x, p.x);
      high_x = std::max(high_x, p.x);
      low_y = std::min(low_y, p.y);
      high_y = std::max(high_y, p.y);
    }
    const std::string name = fmt::format("panel{}curve{}", index, k);
    data += data_block(name, curve.points);
    if (curve.bars) {
      plots += fmt::format("{}${} using 1:2:3:4 with yerrorbars pt 0 lw 1 lc rgb '#999999' notitle",
                           plots.empty() ? "" : ", \\\n  ", name);
    }
    plots +=
        fmt::format("{}${} using 1:2 {} {}", plots.empty() ? "" : ", \\\n  ", name, curve.style,
                    curve.title.empty() ? "notitle" : "title " + plot_text(curve.title));
  }
  std::string text =
      fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", plot_text(panel.title),
                  plot_text(panel.x_label), plot_text(panel.y_label));
  text += panel.legend ? "set key outside right center vertical samplen 2\n" : "unset key\n";
  if (plots.empty()) {
    return text +
           "unset logscale\nset label 1 'no points' at graph 0.5, 0.5 center\n"
           "plot [0:1] [0:1] NaN notitle\nunset label 1\nset logscale xy\n";
  }
  // Margin around the points, even if all are equal.
  return text + data +
         fmt::format("set xrange [{:.6g}:{:.6g}]\nset xtics {}\n", low_x / 1.3, high_x * 1.3,
                     tics(low_x / 1.3, high_x * 1.3)) +
         fmt::format("set yrange [{:.6g}:{:.6g}]\nset ytics {}\nplot {}\n", low_y / 1.3,
                     high_y * 1.3, tics(low_y / 1.3, high_y * 1.3), plots);
}

// The first line of the process's output.
std::string first_line(int descriptor) {
  std::string text;
  std::array<char, 512> buffer{};
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  text.erase(0, text.find_first_not_of(" \n\r\t^"));
  return text.substr(0, text.find('\n'));
}

// In the child: only async-signal-safe calls after fork.
[[noreturn]] void become_gnuplot(const char* folder, int errors, const char* const* arguments) {
  constexpr int no_folder = 126, not_found = 127;
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (::chdir(folder) != 0) ::_exit(no_folder);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  ::execvp(arguments[0], const_cast<char* const*>(arguments));
  ::_exit(errno == ENOENT || errno == EACCES || errno == ENOTDIR ? not_found : no_folder);
}

}  // namespace

std::string plot_text(std::string_view text) {
  std::string quoted = "'";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = character_bytes(text, at);
    const bool plain = bytes > 1 || (bytes == 1 && text[at] >= ' ' && text[at] != 0x7F);
    if (!plain) {
      quoted += '?';
    } else if (text[at] == '\'') {
      quoted += "''";
    } else {
      quoted += text.substr(at, bytes);
    }
    at += std::max<std::size_t>(1, bytes);
  }
  return quoted + "'";
}

std::string plot_script(const std::string& picture, const std::vector<PlotPanel>& panels,
                        int across) {
  const int count = static_cast<int>(panels.size());
  const int down = (count + across - 1) / across;
  std::string text = fmt::format(
      "# Written by earthshine study; gnuplot (package {}) draws it:\n"
      "#   gnuplot SCRIPT, in the script's folder\n"
      "set encoding utf8\n"
      "set terminal svg size {},{} noenhanced background rgb 'white' font 'sans-serif,12'\n"
      "set output {}\n"
      "set logscale xy\nset grid lc rgb '#dddddd'\nset border lc rgb '#555555'\n"
      "set format x '%.3g'\nset format y '%.3g'\nset key noenhanced\n"
      "set multiplot layout {},{}\n",
      plot_package, panel_width_px * std::min(across, count), panel_height_px * down,
      plot_text(picture), down, across);
  for (std::size_t k = 0; k < panels.size(); ++k) text += panel_script(panels[k], k);
  return text + "unset multiplot\nset output\n";
}

std::string draw_plots(const std::filesystem::path& folder,
                       const std::vector<std::string>& scripts) {
  constexpr int not_found = 127;
  std::vector<const char*> arguments = {"gnuplot", "-d"};  // -d: ignores the user's settings
  for (const std::string& script : scripts) arguments.push_back(script.c_str());
  arguments.push_back(nullptr);
  const std::string place = folder.string();
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return "no pipe could be made";
  const pid_t child = ::fork();
  if (child == 0) become_gnuplot(place.c_str(), pipe[1], arguments.data());
  ::close(pipe[1]);
  const std::string said = child > 0 ? first_line(pipe[0]) : "";
  ::close(pipe[0]);
  if (child < 0) return "no process could be started";
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  if (WIFEXITED(status) && WEXITSTATUS(status) == not_found) {
    return fmt::format("there is no gnuplot; the package {} has it", plot_package);
  }
  return "gnuplot failed" + (said.empty() ? "" : ": " + said);
}

}  // namespace earthshine::app
