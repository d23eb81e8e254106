// SPDX-License-Identifier: Apache-2.0
// [[joint]] and [[track]], and their tables against time.
#include "scenes/time/linkage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/input/input_file.h"
#include "scenes/read/mission.h"
#include "scenes/read/scene_parts.h"
#include "scenes/text/csv_lines.h"
#include "scenes/text/message_text.h"
#include "scenes/text/text_lines.h"

namespace earthshine::scenes {
namespace {

using base::Blame;
using base::Error;

constexpr std::string_view joint_keys[] = {"name",  "parent",  "pivot",  "axis",      "angle_deg",
                                           "epoch", "follows", "normal", "limits_deg"};
constexpr std::string_view track_keys[] = {"name",      "parent",     "poses",
                                           "epoch",     "trajectory", "attitude",
                                           "body_axes", "quaternion", "origin"};
constexpr std::size_t max_table_bytes = std::size_t{16} << 20;
constexpr double length_slack = 0.01;  // quaternions are often given with three digits
constexpr Range angles_deg{-1e6, 1e6};

// A CSV file against time: a column of moments, and columns of numbers.
class MotionFile {
 public:
  MotionFile(Scene& scene, const TableReader& table, std::string_view key, std::string named)
      : path_(scene.files.emplace_back(scene.path.parent_path() / named)),
        text_(base::read_input_file(path_, max_table_bytes, table.where(key))),
        lines_(text_, path_.string()),
        epoch_(read_moment(table, "epoch")) {
    if (mission_of(scene) == nullptr) {
      table.fail(key, "names a table against time, and the scene has no dates", {},
                 "Write [time], and [orbit] with trajectory = \"FILE.oem\", or give a number");
    }
    if (lines_.next()) {
      for (const CsvField& field : lines_.fields()) header_.push_back(std::string(field.text));
      header_at_ = lines_.fields().front().where;
    }
    for (const std::string& column : header_) {
      if (std::ranges::count(header_, column) == 1) continue;
      throw Error(Blame::Input, header_at_, fmt::format("two columns {}", in_quotes(column)),
                  "each column has a name of its own");
    }
    by_utc_ = has("utc");
    if (by_utc_ == has("time_s")) {
      throw Error(Blame::Input, {path_.string(), lines_.line(), 0},
                  "the header names " + (by_utc_ ? "both utc and time_s" : listed(header_)),
                  "a header names utc, or time_s in seconds after epoch, and the values");
    }
    if (!by_utc_ && !epoch_) {
      table.missing("epoch", "epoch = \"2026-03-01T12:00:00\", where time_s of the table is 0");
    }
    if (by_utc_ && epoch_) table.fail("epoch", "has no effect: the table has a column utc");
  }

  [[nodiscard]] bool has(std::string_view column) const {
    return std::find(header_.begin(), header_.end(), column) != header_.end();
  }
  [[nodiscard]] const base::Location& header_at() const { return header_at_; }
  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }

  // Throws for a column that is neither one of these nor the time.
  void allow(const std::vector<std::string>& columns) const {
    for (const std::string& column : header_) {
      if (column == "utc" || column == "time_s") continue;
      if (std::ranges::find(columns, column) != columns.end()) continue;
      throw Error(Blame::Input, header_at_, fmt::format("the column {}", in_quotes(column)),
                  "allowed are utc or time_s and " + listed(columns));
    }
  }

  // Rows of these columns; add(numbers, line) makes their values.
  template <class Value, class Make>
  MotionTable<Value> read(const std::vector<std::string>& columns, Make make) {
    std::vector<std::size_t> places;
    for (const std::string& column : columns) {
      const auto found = std::find(header_.begin(), header_.end(), column);
      if (found == header_.end()) {
        throw Error(Blame::Input, header_at_, fmt::format("there is no column {}", column),
                    "the header names " + listed(header_), did_you_mean(column, header_));
      }
      places.push_back(static_cast<std::size_t>(found - header_.begin()));
    }
    MotionTable<Value> table;
    table.file = path_.string();
    while (lines_.next()) {
      const auto& fields = lines_.fields();
      if (fields.size() != header_.size()) {
        throw Error(Blame::Input, {path_.string(), lines_.line(), 0},
                    fmt::format("a row of {} columns", fields.size()),
                    fmt::format("the header names {}", header_.size()));
      }
      std::vector<double> numbers;
      for (const std::size_t place : places) numbers.push_back(number(fields[place]));
      const Instant at = moment(fields);
      if (!table.at.empty() && !(at > table.at.back())) {
        throw Error(Blame::Input, {path_.string(), lines_.line(), 0},
                    fmt::format("{} after {}", utc_text(at), utc_text(table.at.back())),
                    "times rise from row to row");
      }
      if (table.at.empty()) table.first_line = lines_.line();
      table.last_line = lines_.line();
      table.at.push_back(at);
      table.values.push_back(make(numbers, base::Location{path_.string(), lines_.line(), 0}));
    }
    if (table.at.empty()) {
      throw Error(Blame::Input, header_at_, "the table has no rows", "it has one or more");
    }
    return table;
  }

 private:
  static double number(const CsvField& field) {
    const auto found = number_in(field.text);
    if (found && std::abs(*found) <= largest_length) return *found;
    throw Error(
        Blame::Input, field.where, fmt::format("{} is no number", in_quotes(field.text)),
        fmt::format("allowed are numbers from {0:g} to {1:g}", -largest_length, largest_length));
  }

  [[nodiscard]] Instant moment(const std::vector<CsvField>& fields) const {
    const auto column = std::find(header_.begin(), header_.end(), by_utc_ ? "utc" : "time_s");
    const CsvField& field = fields[static_cast<std::size_t>(column - header_.begin())];
    if (!by_utc_) return *epoch_ + number(field);
    const auto found = read_instant(field.text, TimeSystem::Utc);
    if (found) return *found;
    throw Error(Blame::Input, field.where, fmt::format("{} is no date", in_quotes(field.text)),
                "allowed is UTC such as 2026-03-01T12:00:00 or 2026-060T12:00:00");
  }

  std::filesystem::path path_;
  std::string text_;
  CsvLines lines_;
  std::optional<Instant> epoch_;
  std::vector<std::string> header_;
  base::Location header_at_;
  bool by_utc_ = false;
};

SunFollower read_follower(const Scene& scene, const TableReader& table, const Vec3& axis) {
  constexpr std::string_view followed[] = {"sun"};
  constexpr double least_sine = 1e-3;
  (void)table.choice("follows", followed);
  for (const char* key : {"angle_deg", "epoch"}) {
    if (table.has(key)) {
      table.fail(key, "cannot be combined with \"follows\"", "the Sun gives the angle");
    }
  }
  if (!scene.sun) table.fail("follows", "is \"sun\", and the scene has no [sun]");
  SunFollower follower;
  follower.normal = table.required(table.direction("normal"), "normal",
                                   "normal = [x, y, z], which is turned to the Sun");
  if (!(glm::length(glm::cross(follower.normal, axis)) > least_sine)) {
    table.fail("normal", "is along the axis", "it turns about the axis to face the Sun");
  }
  if (const TomlEntry* limits = table.find("limits_deg")) {
    const std::vector<double> pair = numbers_of(limits->node);
    const bool good = pair.size() == 2 && pair[0] >= -360.0 && pair[0] <= pair[1] &&
                      pair[1] <= 360.0 && pair[1] - pair[0] <= 360.0;
    if (!good) {
      table.fail("limits_deg", "is " + describe(limits->node),
                 "allowed are two angles from -360 to 360, rising, at most 360 apart");
    }
    follower.lowest_deg = pair[0];
    follower.highest_deg = pair[1];
  }
  return follower;
}

Joint read_joint(Scene& scene, const TableReader& table, double unit_m, std::string name) {
  Joint joint;
  joint.name = std::move(name);
  joint.pivot_m = table.required(table.position("pivot", unit_m), "pivot", "pivot = [x, y, z]");
  joint.axis = table.required(table.direction("axis"), "axis", "axis = [x, y, z]");
  if (table.has("follows")) {
    joint.motion = read_follower(scene, table, joint.axis);
    return joint;
  }
  for (const char* key : {"normal", "limits_deg"}) {
    if (table.has(key)) table.fail(key, "belongs to follows = \"sun\"");
  }
  const TomlEntry* angle = table.find("angle_deg");
  if (angle == nullptr || !std::holds_alternative<std::string>(angle->node.value)) {
    joint.motion = table.number("angle_deg", angles_deg).value_or(0.0);
    if (table.has("epoch")) table.fail("epoch", "belongs to a table", "the angle is a number");
    return joint;
  }
  MotionFile file(scene, table, "angle_deg", *table.text("angle_deg"));
  const std::string column = file.has(joint.name) ? joint.name : "angle_deg";
  if (!file.has(column)) {
    throw Error(Blame::Input, file.header_at(),
                fmt::format("no column for the joint {}", in_quotes(joint.name)),
                fmt::format("a column is named {} or angle_deg; the header names {}", joint.name,
                            listed(file.header())));
  }
  joint.motion = file.read<double>({column}, [](const std::vector<double>& numbers,
                                                const base::Location&) { return numbers[0]; });
  return joint;
}

PoseTable read_poses(Scene& scene, const TableReader& table, double unit_m) {
  MotionFile file(scene, table, "poses", *table.text("poses"));
  std::vector<std::string> columns = {"x", "y", "z"};
  file.allow({"x", "y", "z", "qw", "qx", "qy", "qz", "rotate_x", "rotate_y", "rotate_z"});
  const bool by_quaternion = file.has("qw") || file.has("qx") || file.has("qy") || file.has("qz");
  const bool by_angles = file.has("rotate_x") || file.has("rotate_y") || file.has("rotate_z");
  if (by_quaternion && by_angles) {
    throw Error(Blame::Input, file.header_at(), "both a quaternion and angles are there",
                "a header names qw, qx, qy, qz or rotate_x, rotate_y, rotate_z or none of them");
  }
  if (by_quaternion) columns.insert(columns.end(), {"qw", "qx", "qy", "qz"});
  if (by_angles) columns.insert(columns.end(), {"rotate_x", "rotate_y", "rotate_z"});
  std::optional<Vec3> before_deg;
  std::string first_jump;
  int more_jumps = 0;
  PoseTable poses =
      file.read<TablePose>(columns, [&](const std::vector<double>& n, const base::Location& where) {
        TablePose pose{unit_m * Vec3(n[0], n[1], n[2]), {1.0, 0.0, 0.0, 0.0}};
        if (by_angles) {
          const Vec3 row_deg(n[3], n[4], n[5]);
          const double step_deg =
              before_deg ? base::max_component(glm::abs(row_deg - *before_deg)) : 0.0;
          if (step_deg > 180.0 && first_jump.empty()) {
            first_jump = fmt::format("{}:{}: the angles change by {:g} deg from the row before",
                                     where.file, where.line, step_deg);
          } else if (step_deg > 180.0) {
            ++more_jumps;
          }
          before_deg = row_deg;
          pose.rotation = glm::quat_cast(rotation_xyz(row_deg));
        }
        if (!by_quaternion) return pose;
        const glm::dquat q(n[3], n[4], n[5], n[6]);
        if (!(std::abs(glm::length(q) - 1.0) <= length_slack)) {
          throw Error(Blame::Input, where,
                      fmt::format("the quaternion has length {:.6g}", glm::length(q)),
                      "a turn has length 1, within 1 %; qw is the scalar");
        }
        pose.rotation = glm::normalize(q);
        return pose;
      });
  if (!first_jump.empty()) {
    scene.warnings.push_back(fmt::format(
        "{}{}; between rows the turn is the shorter way. Give rows less than 180 deg apart, as "
        "every 120 deg",
        first_jump, more_jumps > 0 ? fmt::format(" ({} more such)", more_jumps) : std::string()));
  }
  return poses;
}

Visitor read_visitor(Scene& scene, const TableReader& table, double unit_m) {
  const Mission* mission = mission_of(scene);
  if (mission == nullptr) {
    table.fail("trajectory", "is given without a trajectory of the scene",
               "the other spacecraft is placed relative to it",
               "Write [orbit] with trajectory = \"FILE.oem\"");
  }
  const auto file = [&](std::string_view key) {
    return scene.files.emplace_back(scene.path.parent_path() / *table.text(key));
  };
  Visitor visitor;
  visitor.trajectory = read_trajectory(file("trajectory"), mission->clock,
                                       table.where("trajectory"), scene.warnings);
  if (table.has("attitude")) {
    visitor.body_axes = read_body_axes(table);
    visitor.attitude =
        read_attitude_history(file("attitude"), mission->clock, read_scalar_place(table),
                              table.where("attitude"), scene.warnings);
  }
  visitor.origin_m = table.position("origin", unit_m).value_or(Vec3(0.0));
  return visitor;
}

Joint read_track(Scene& scene, const TableReader& table, double unit_m, std::string name) {
  Joint track;
  track.name = std::move(name);
  if (table.has("poses") == table.has("trajectory")) {
    table.fail(
        table.has("poses") ? "poses" : "name",
        table.has("poses") ? "cannot be combined with \"trajectory\"" : "comes without a motion",
        "a track has poses = \"FILE.csv\" or trajectory = \"FILE.oem\"");
  }
  const bool by_poses = table.has("poses");
  for (const char* key : {"attitude", "body_axes", "quaternion", "origin"}) {
    if (by_poses && table.has(key)) table.fail(key, "belongs to a track with a trajectory");
  }
  for (const char* key : {"body_axes", "quaternion"}) {
    if (table.has(key) && !table.has("attitude")) table.fail(key, "belongs to an attitude");
  }
  for (const char* key : {"epoch", "parent"}) {
    if (!by_poses && table.has(key)) table.fail(key, "belongs to a track with poses");
  }
  if (by_poses) {
    track.motion = read_poses(scene, table, unit_m);
  } else {
    track.motion = read_visitor(scene, table, unit_m);
  }
  return track;
}

std::vector<std::string> names_of(const Linkage& linkage) {
  std::vector<std::string> names;
  for (const Joint& joint : linkage.joints) names.push_back(joint.name);
  return names;
}

// The list of ancestors that comes back to the joint, "a, b, a"; "" where it ends.
std::string circle_from(const Linkage& linkage, std::size_t joint) {
  std::string chain = linkage.joints[joint].name;
  auto parent = linkage.joints[joint].parent;
  for (std::size_t steps = 0; parent && steps < linkage.joints.size(); ++steps) {
    chain += " on " + linkage.joints[*parent].name;
    if (*parent == joint) return chain;
    parent = linkage.joints[*parent].parent;
  }
  return "";
}

}  // namespace

void read_linkage(Scene& scene, const TableReader& root, double unit_m) {
  auto linkage = std::make_shared<Linkage>();
  struct Entry {
    TableReader table;
    bool is_joint;
  };
  std::vector<Entry> entries;
  std::vector<const TomlNode*> nodes;
  for (const bool is_joint : {true, false}) {
    const char* const key = is_joint ? "joint" : "track";
    for (const TomlNode* node : named_entries(root, key)) {
      TableReader table(*node, fmt::format("[[{}]]", key),
                        is_joint ? KeyList(joint_keys) : KeyList(track_keys));
      std::string name = table.read_name();
      linkage->joints.push_back(is_joint ? read_joint(scene, table, unit_m, std::move(name))
                                         : read_track(scene, table, unit_m, std::move(name)));
      entries.push_back({std::move(table), is_joint});
      nodes.push_back(node);
    }
  }
  if (entries.empty()) return;
  const std::vector<std::string> names = names_of(*linkage);
  check_unique(names, nodes, "[[joint]] and [[track]]");
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto parent = entries[k].table.text("parent");
    if (!parent) continue;
    const auto found = std::find(names.begin(), names.end(), *parent);
    if (found == names.end()) {
      entries[k].table.fail("parent", fmt::format("is {}", in_quotes(*parent)),
                            "allowed are joints and tracks: " + listed(names),
                            did_you_mean(*parent, names));
    }
    linkage->joints[k].parent = static_cast<std::size_t>(found - names.begin());
  }
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const std::string circle = circle_from(*linkage, k);
    if (circle.empty()) continue;
    entries[k].table.fail("parent", fmt::format("makes the joint its own ancestor: {}", circle),
                          "joints are a tree: the first of an arm has no parent");
  }
  scene.linkage = std::move(linkage);
}

JointPoses::JointPoses(const Scene& scene) {
  if (!scene.linkage) return;
  names_ = names_of(*scene.linkage);
  for (const JointState& state : joints_now(scene)) {
    poses_.push_back(state.pose);
  }
}

Pose JointPoses::of(const TableReader& table) const {
  const auto named = table.text("joint");
  if (!named) return {};
  const auto found = std::find(names_.begin(), names_.end(), *named);
  if (found == names_.end()) {
    table.fail("joint", fmt::format("is {}", in_quotes(*named)),
               names_.empty() ? "the scene has no [[joint]] and no [[track]]"
                              : "allowed are joints and tracks: " + listed(names_),
               did_you_mean(*named, names_));
  }
  return poses_[static_cast<std::size_t>(found - names_.begin())];
}

}  // namespace earthshine::scenes
