#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "io/motion/motion_files.h"

/// Programs in the languages of robots, from one list of points.
namespace tuft::io {
namespace {

using motion::Move;
using motion::MoveKind;

constexpr double kMm = 1000;
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kUpright = 3 / kDegrees;  // lean of a holder that a plotter can be taken for

/// A point, the speed of the straight line that leads to it, and its duration.
struct Step {
    MotionFrame tcp;
    double speed = 0, time = 0;
};

template <class Visit>
void for_steps(const Move& move, const MotionFrame& base, Visit&& visit) {
    for (std::size_t i = 1; i < move.points.size(); ++i) {
        const brush::Pose &a = move.points[i - 1].pose, &b = move.points[i].pose;
        const double time = b.time - a.time;
        visit(Step{tcp_of(b, base), time > 0 ? glm::length(b.position - a.position) / time : 0, time});
    }
}

std::string comment_of(const MotionProgram& program, const Move& move) {
    std::string text = fmt::format("{} {}", motion::name_of(move.kind), move.stroke + 1);
    if (move.kind != MoveKind::stroke) return text;
    const stroke::RecordedStroke& s = program.strokes[move.stroke];
    text += ": " + s.brush + ", " + s.ink;
    std::erase_if(text, [](unsigned char c) { return c < 32 || c == '(' || c == ')'; });
    return text;
}

/// Axis times angle, radians.
Vec3 rotation_vector(const Quat& q) {
    const Quat r = q.w < 0 ? -q : q;
    const Vec3 v(r.x, r.y, r.z);
    const double sine = glm::length(v);
    return sine < 1e-12 ? 2.0 * v : 2 * std::atan2(sine, r.w) / sine * v;
}

/// KUKA's A, B, C: rotations about z, the new y and the new x, degrees.
Vec3 abc_of(const Quat& q) {
    const Mat3 m = glm::mat3_cast(q);  // m[column][row]
    const double b = std::atan2(-m[0][2], std::hypot(m[0][0], m[0][1]));
    const bool upright = std::hypot(m[0][0], m[0][1]) > 1e-9;
    const double a = upright ? std::atan2(m[0][1], m[0][0]) : std::atan2(-m[1][0], m[1][1]);
    const double c = upright ? std::atan2(m[1][2], m[2][2]) : 0;
    return kDegrees * Vec3(a, b, c);
}

std::string ur_pose(const MotionFrame& f) {
    const Vec3 r = rotation_vector(f.rotation);
    return fmt::format("p[{:.6f}, {:.6f}, {:.6f}, {:.6f}, {:.6f}, {:.6f}]", f.position.x, f.position.y, f.position.z,
                       r.x, r.y, r.z);
}

std::string krl_pose(const MotionFrame& f) {
    const Vec3 abc = abc_of(f.rotation), p = kMm * f.position;
    return fmt::format("{{X {:.4f}, Y {:.4f}, Z {:.4f}, A {:.4f}, B {:.4f}, C {:.4f}}}", p.x, p.y, p.z, abc.x, abc.y,
                       abc.z);
}

std::string rapid_pose(const MotionFrame& f) {
    const Vec3 p = kMm * f.position;
    const Quat& q = f.rotation;
    return fmt::format("[{:.4f}, {:.4f}, {:.4f}], [{:.8f}, {:.8f}, {:.8f}, {:.8f}]", p.x, p.y, p.z, q.w, q.x, q.y, q.z);
}

}  // namespace

MotionFrame tcp_of(const brush::Pose& pose, const MotionFrame& base) {
    // Half a turn about x: the ferrule's hair points along −z, the tool's z along it.
    return {base.position + base.rotation * pose.position,
            glm::normalize(base.rotation * pose.rotation * Quat(0, 1, 0, 0))};
}

std::string urscript_text(const MotionProgram& program) {
    std::string text = fmt::format("def {}():\n  set_tcp({})\n", program.title, ur_pose(program.tool));
    for (const Move& move : program.trajectory.moves) {
        text += "  # " + comment_of(program, move) + "\n";
        if (&move == &program.trajectory.moves.front())
            text += fmt::format("  movej({}, a=0.5, v=0.3)\n", ur_pose(tcp_of(move.points.front().pose, program.base)));
        for_steps(move, program.base, [&](const Step& step) {
            if (move.kind == MoveKind::stroke && step.speed > 0)
                text += fmt::format("  movep({}, a={:.4f}, v={:.6f}, r=0)\n", ur_pose(step.tcp),
                                    program.limits.acceleration, step.speed);
            else
                text += fmt::format("  movel({}, a={:.4f}, v={:.6f}, t={:.6f}, r=0)\n", ur_pose(step.tcp),
                                    program.limits.acceleration, std::max(step.speed, 1e-4), step.time);
        });
    }
    return text + "end\n" + program.title + "()\n";
}

std::string rapid_text(const MotionProgram& program) {
    std::string text = fmt::format(
        "MODULE {0}\n  PERS tooldata tBrush := [TRUE, [{1}], [0.5, [0, 0, 50], [1, 0, 0, 0], 0, 0, 0]];\n"
        "  PROC main()\n    ConfL \\Off;\n    AccSet 100, 100;\n",
        program.title, rapid_pose(program.tool));
    const auto target = [](const MotionFrame& f) {
        return fmt::format("[{}, [0, 0, 0, 0], [9E9, 9E9, 9E9, 9E9, 9E9, 9E9]]", rapid_pose(f));
    };
    for (const Move& move : program.trajectory.moves) {
        text += "    ! " + comment_of(program, move) + "\n";
        if (&move == &program.trajectory.moves.front())
            text += fmt::format("    MoveJ {}, v200, fine, tBrush;\n",
                                target(tcp_of(move.points.front().pose, program.base)));
        for_steps(move, program.base, [&](const Step& step) {
            text += fmt::format("    MoveL {}, [{:.4f}, 90, 200, 15] \\T:={:.6f}, z0, tBrush;\n", target(step.tcp),
                                std::max(kMm * step.speed, 0.1), step.time);
        });
    }
    return text + "  ENDPROC\nENDMODULE\n";
}

std::string krl_text(const MotionProgram& program) {
    // INITMOV gives the speeds of axes and of turning, which a controller does not start with, and resets $TOOL.
    std::string text = fmt::format(
        "&ACCESS RVP\nDEF {0}( )\n  BAS (#INITMOV, 0)\n  $TOOL = {1}\n  $BASE = $NULLFRAME\n  $ACC.CP = {2:.4f}\n  "
        "$APO.CDIS = 0.1\n",
        program.title, krl_pose(program.tool), program.limits.acceleration);
    for (const Move& move : program.trajectory.moves) {
        text += "  ; " + comment_of(program, move) + "\n";
        if (&move == &program.trajectory.moves.front())
            text += "  PTP " + krl_pose(tcp_of(move.points.front().pose, program.base)) + "\n";
        for_steps(move, program.base, [&](const Step& step) {
            text += fmt::format("  $VEL.CP = {:.6f}\n  LIN {} C_DIS\n", std::max(step.speed, 1e-4), krl_pose(step.tcp));
        });
    }
    return text + "END\n";
}

std::string gcode_text(const MotionProgram& program) {
    std::string text = fmt::format("({})\nG21\nG90\nG94\n", program.title);
    for (const Move& move : program.trajectory.moves) {
        text += "(" + comment_of(program, move) + ")\n";
        for (const motion::Waypoint& p : move.points)
            if (const double lean = std::acos(std::clamp(-p.pose.axis().z, -1.0, 1.0)); lean > kUpright)
                throw Error(
                    Message("stroke {}: its holder leans by {} degrees, but G-code holds it upright; write another "
                            "form",
                            move.stroke + 1, std::lround(kDegrees * lean)));
        if (&move == &program.trajectory.moves.front()) {
            const Vec3 p = kMm * tcp_of(move.points.front().pose, program.base).position;
            text += fmt::format("G0 X{:.4f} Y{:.4f} Z{:.4f}\n", p.x, p.y, p.z);
        }
        for_steps(move, program.base, [&](const Step& step) {
            const Vec3 p = kMm * step.tcp.position;
            if (step.speed > 0)
                text += fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f} F{:.3f}\n", p.x, p.y, p.z, 60 * kMm * step.speed);
            else
                text += fmt::format("G4 P{:.4f}\n", step.time);
        });
    }
    return text + "M2\n";
}

}  // namespace tuft::io
