#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "core/files/text_file.h"
#include "core/text/nesting.h"
#include "io/motion/motion_files.h"
#include "io/motion/stroke_description.h"

/// The neutral list of a trajectory, written and read.
namespace tuft::io {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "tuft-trajectory";
constexpr int kVersion = 2;  // 2: points of strokes have the hand's clock
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr std::size_t kColumns = 11;  // t x y z qw qx qy qz fx fy fz, then the hand's clock where there is one

json frame_json(const MotionFrame& f) {
    return {{"position", {f.position.x, f.position.y, f.position.z}},
            {"rotation", {f.rotation.w, f.rotation.x, f.rotation.y, f.rotation.z}}};
}

json point_json(const motion::Waypoint& p) {
    const brush::Pose& pose = p.pose;
    json columns{pose.time,       pose.position.x, pose.position.y, pose.position.z, pose.rotation.w, pose.rotation.x,
                 pose.rotation.y, pose.rotation.z, p.force.x,       p.force.y,       p.force.z};
    if (p.hand_time) columns.push_back(*p.hand_time);
    return columns;
}

/// Adds the points of a stroke's move, its clock from 0: the hand's where there is one, else the tool's.
void add_samples(const json& points, stroke::RecordedStroke& s) {
    double start = 0;
    for (const json& p : points) {
        if (!p.is_array() || p.size() < kColumns || p.size() > kColumns + 1 || p.size() != points.front().size())
            throw Error("a point has neither 11 nor 12 numbers");
        std::array<double, kColumns + 1> v{};
        for (std::size_t i = 0; i < p.size(); ++i) v[i] = p[i].get<double>();
        const double time = p.size() > kColumns ? v[kColumns] : v[0];
        if (s.samples.empty()) start = time;
        stroke::StrokeSample sample;
        sample.time = time - start;
        sample.position = {v[1], v[2], v[3]};
        sample.rotation = Quat(v[4], v[5], v[6], v[7]);
        s.samples.push_back(sample);
    }
}

std::vector<stroke::RecordedStroke> strokes_of_list(const json& file) {
    if (file.at("format") != kFormat) throw Error("is no trajectory of tuft");
    if (file.at("version").get<int>() > kVersion) throw Error("is of a later version of tuft");
    std::vector<stroke::RecordedStroke> strokes;
    for (const json& j : file.at("strokes")) strokes.push_back(stroke_of(j));
    for (const json& move : file.at("moves")) {
        if (move.at("kind") != "stroke") continue;
        const auto i = move.at("stroke").get<std::size_t>();
        if (i >= strokes.size()) throw Error("a move belongs to no stroke");
        add_samples(move.at("points"), strokes[i]);
    }
    for (const stroke::RecordedStroke& s : strokes) stroke::check_samples(s);
    return strokes;
}

}  // namespace

std::string trajectory_json(const MotionProgram& program) {
    json file{{"format", kFormat},
              {"version", kVersion},
              {"units",
               "seconds, metres, newtons; points: t, x, y, z, qw, qx, qy, qz, fx, fy, fz of the ferrule's "
               "mouth, model frame; its hair points along -z; in strokes also the hand's clock"},
              {"base", frame_json(program.base)},
              {"tool", frame_json(program.tool)},
              {"seconds", program.trajectory.seconds()},
              {"strokes", json::array()},
              {"moves", json::array()}};
    for (const stroke::RecordedStroke& s : program.strokes) file["strokes"].push_back(stroke_json(s));
    for (const motion::Move& move : program.trajectory.moves) {
        json points = json::array();
        for (const motion::Waypoint& p : move.points) points.push_back(point_json(p));
        file["moves"].push_back(
            {{"kind", motion::name_of(move.kind)}, {"stroke", move.stroke}, {"points", std::move(points)}});
    }
    return file.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

bool is_gcode(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    return extension == ".gcode" || extension == ".nc";
}

void write_trajectory(const std::filesystem::path& path, const MotionProgram& program) {
    const std::string extension = lower_extension(path);
    if (extension == ".json") return write_text(path, trajectory_json(program));
    if (extension == ".csv") return write_text(path, trajectory_csv(program));
    if (extension == ".urscript" || extension == ".script") return write_text(path, urscript_text(program));
    if (extension == ".mod") return write_text(path, rapid_text(program));
    if (extension == ".src") return write_text(path, krl_text(program));
    if (is_gcode(path)) return write_text(path, gcode_text(program));
    throw Error(path.string(), "a trajectory is written as .json, .csv, .urscript, .mod, .src or .gcode");
}

std::vector<stroke::RecordedStroke> read_trajectory(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path, kMostBytes);
    const std::string name = path.string();
    if (lower_extension(path) == ".csv") return parse_trajectory_csv({bytes.data(), bytes.size()}, name);
    check_json_nesting({bytes.data(), bytes.size()}, name);
    try {
        return strokes_of_list(json::parse(bytes.begin(), bytes.end()));
    } catch (const json::exception&) {
        throw Error(name, "is no trajectory of tuft");
    } catch (const Error& error) {
        throw Error(name, error.message());
    }
}

}  // namespace tuft::io
