#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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
constexpr double kLeastSpeed = 1e-4;       // m/s; a slower hand waits at the end of its way
constexpr double kLeastTurn = 1e-3;        // rad, of one whose printed speed is right to 1 %

/// A straight way to a place: metres, radians, seconds.
struct Step {
    MotionFrame tcp;
    double length = 0, turn = 0, time = 0;

    double speed() const { return time > 0 ? length / time : 0; }
};

/// Lengths between places as they are printed: what is lost or gained by rounding one step is made up in the next.
class PrintedWay {
  public:
    explicit PrintedWay(double digit) : digit_(digit) {}

    void start(const Vec3& at) { at_ = glm::round(at / digit_); }
    /// Metres per second from the place before.
    double speed_to(const Step& step) {
        const Vec3 from = at_;
        start(step.tcp.position);
        return step.time > 0 ? digit_ * glm::length(at_ - from) / step.time : 0;
    }

  private:
    double digit_;  // metres
    Vec3 at_{0};
};

template <class Visit>
void for_steps(const Move& move, const MotionFrame& base, Visit&& visit) {
    for (std::size_t i = 1; i < move.points.size(); ++i) {
        const brush::Pose &a = move.points[i - 1].pose, &b = move.points[i].pose;
        visit(Step{tcp_of(b, base), glm::length(b.position - a.position), motion::angle_between(a.rotation, b.rotation),
                   b.time - a.time});
    }
}

/// Where the first move begins.
MotionFrame start_of(const MotionProgram& program) {
    return tcp_of(program.trajectory.moves.front().points.front().pose, program.base);
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
    std::string at;
    PrintedWay way(1e-6);
    for (const Move& move : program.trajectory.moves) {
        text += "  # " + comment_of(program, move) + "\n";
        if (at.empty()) {
            text += fmt::format("  movej({}, a=0.5, v=0.3)\n", at = ur_pose(start_of(program)));
            way.start(start_of(program).position);
        }
        for_steps(move, program.base, [&](const Step& step) {
            const std::string to = ur_pose(step.tcp);
            const double speed = way.speed_to(step);
            if (to == at)
                text += fmt::format("  sleep({:.6f})\n", step.time);
            else if (move.kind == MoveKind::stroke && speed >= kLeastSpeed)
                text += fmt::format("  movep({}, a={:.4f}, v={:.6f}, r=0)\n", to, program.limits.acceleration, speed);
            else
                text += fmt::format("  movel({}, a={:.4f}, v={:.6f}, t={:.6f}, r=0)\n", to, program.limits.acceleration,
                                    std::max(speed, kLeastSpeed), step.time);
            at = to;
        });
    }
    return text + "end\n" + program.title + "()\n";
}

std::string rapid_text(const MotionProgram& program) {
    std::string text = fmt::format(
        "MODULE {0}\n  PERS tooldata tBrush := [TRUE, [{1}], [0.5, [0, 0, 50], [1, 0, 0, 0], 0, 0, 0]];\n"
        "  PROC main()\n    ConfL \\Off;\n    AccSet 100, 100;\n",
        program.title, rapid_pose(program.tool));
    const auto target = [](const std::string& pose) {
        return fmt::format("[{}, [0, 0, 0, 0], [9E9, 9E9, 9E9, 9E9, 9E9, 9E9]]", pose);
    };
    std::string at;
    for (const Move& move : program.trajectory.moves) {
        text += "    ! " + comment_of(program, move) + "\n";
        if (at.empty())
            text += fmt::format("    MoveJ {}, v200, fine, tBrush;\n", target(at = rapid_pose(start_of(program))));
        for_steps(move, program.base, [&](const Step& step) {
            const std::string to = rapid_pose(step.tcp);
            if (to == at)
                text += fmt::format("    WaitTime \\InPos, {:.6f};\n", step.time);
            else
                text += fmt::format("    MoveL {}, [{:.4f}, 90, 200, 15] \\T:={:.6f}, z0, tBrush;\n", target(to),
                                    std::max(kMm * step.speed(), kMm * kLeastSpeed), step.time);
            at = to;
        });
    }
    return text + "  ENDPROC\nENDMODULE\n";
}

std::string krl_text(const MotionProgram& program) {
    const auto turning = [](double speed) {
        return fmt::format("  $VEL.ORI1 = {0:.4f}\n  $VEL.ORI2 = {0:.4f}\n", kDegrees * speed);
    };
    const std::string fastest = turning(program.limits.turn);
    // INITMOV gives the speeds of axes, which a controller does not start with, and resets $TOOL.
    std::string text = fmt::format(
        "&ACCESS RVP\nDEF {0}( )\n  BAS (#INITMOV, 0)\n  $TOOL = {1}\n  $BASE = $NULLFRAME\n  $ACC.CP = {2:.4f}\n{3}"
        "  $APO.CDIS = 0.1\n",
        program.title, krl_pose(program.tool), program.limits.acceleration, fastest);
    std::string at, turns = fastest;
    for (const Move& move : program.trajectory.moves) {
        text += "  ; " + comment_of(program, move) + "\n";
        if (at.empty()) text += "  PTP " + (at = krl_pose(start_of(program))) + "\n";
        for_steps(move, program.base, [&](const Step& step) {
            const std::string to = krl_pose(step.tcp);
            if (to == at) {
                text += fmt::format("  WAIT SEC {:.6f}\n", step.time);
                return;
            }
            at = to;
            // A holder that turns in its place has no speed of the path: that of its turn keeps the time.
            const double spare = step.time - step.length / kLeastSpeed;
            const bool in_place = spare > 0 && step.turn > kLeastTurn && step.turn > kLeastTurn * step.time;
            const std::string turn = in_place ? turning(step.turn / step.time) : fastest;
            if (turn != turns) text += turns = turn;
            text += fmt::format("  $VEL.CP = {:.6f}\n  LIN {} C_DIS\n", std::max(step.speed(), kLeastSpeed), to);
            if (spare > 0 && !in_place) text += fmt::format("  WAIT SEC {:.6f}\n", spare);
        });
    }
    return text + "END\n";
}

std::string gcode_text(const MotionProgram& program) {
    std::string text = fmt::format("({})\nG21\nG90\nG94\n", program.title);
    const auto place = [](const MotionFrame& f) {
        return fmt::format("X{:.4f} Y{:.4f} Z{:.4f}", kMm * f.position.x, kMm * f.position.y, kMm * f.position.z);
    };
    std::string at;
    PrintedWay way(1e-7);
    for (const Move& move : program.trajectory.moves) {
        text += "(" + comment_of(program, move) + ")\n";
        double lean = 0;
        for (const motion::Waypoint& p : move.points)
            lean = std::max(lean, std::acos(std::clamp(-p.pose.axis().z, -1.0, 1.0)));
        if (lean > kUpright)
            throw Error(
                Message("stroke {}: its holder leans by {} degrees, but G-code holds it upright; write another form",
                        move.stroke + 1, std::lround(kDegrees * lean)));
        if (at.empty()) {
            text += "G0 " + (at = place(start_of(program))) + "\n";
            way.start(start_of(program).position);
        }
        for_steps(move, program.base, [&](const Step& step) {
            const std::string to = place(step.tcp);
            const double speed = way.speed_to(step);
            if (to == at)
                text += fmt::format("G4 P{:.4f}\n", step.time);
            else  // a controller refuses a feed of 0
                text += fmt::format("G1 {} F{:.6f}\n", to, std::max(60 * kMm * speed, 1e-6));
            at = to;
        });
    }
    return text + "M2\n";
}

std::string program_title(const std::filesystem::path& file) {
    // Words of the three languages, and what the programs call.
    static constexpr std::string_view kTaken =
        " accset alias and anin anout backward bas bool brake break case char circ circ_rel confl connect const "
        "continue "
        "decl def default defdat deffct delay div do elif else elseif end enddat endfct endfor endfunc endif endloop "
        "endmodule endproc endrecord endswitch endtest endtrap endwhile enter_critical enum error exit exit_critical "
        "exor ext extfct false fine for from func global goto halt if import in inout int interrupt is lin lin_rel "
        "local "
        "loop main maximum minimum mod module movej movel movep nostepin not noview or pers prio proc ptp ptp_rel "
        "public "
        "raise readonly real record repeat retry return sec set_tcp signal sleep step struc switch sysmodule tbrush "
        "test "
        "then thread to trap trigger true trynext undo until var viewonly wait waittime when while with xor ";
    std::string name = file.stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    std::string word = " ";
    for (const char c : name) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0])) ||
        kTaken.find(word + " ") != std::string_view::npos)
        name = "p_" + name;
    return name.substr(0, 24);  // the longest name that KRL takes
}

}  // namespace tuft::io
