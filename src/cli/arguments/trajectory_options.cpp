#include "cli/arguments/options.h"
#include "core/text/text.h"

namespace tuft::cli {
namespace {

void add_frame(CLI::App* app, const std::string& name, std::vector<double>& to, const std::string& what) {
    app->add_option_function<std::string>(
           name,
           [&to, name](const std::string& text) {
               to = numbers(text, ',', 6, kFarthestMm);
               if (to.empty())
                   throw CLI::ValidationError(
                       name, "'" + excerpt(text) + "' is not X,Y,Z,RX,RY,RZ in millimetres and degrees");
           },
           what)
        ->type_name("X,Y,Z,RX,RY,RZ");
}

}  // namespace

CLI::App* add_trajectory(CLI::App& app, TrajectoryWork& work) {
    auto* s = app.add_subcommand("trajectory", "write a project's strokes as motions of a robot or plotter");
    s->add_option("PROJECT", work.project, "project file (.tuft)")->required();
    s->add_option(
         "-o,--output", work.output,
         ".json or .csv (neutral; 'tuft paint --strokes' reads both), .urscript, .mod (RAPID), .src (KRL) or .gcode "
         "(flat sheets)")
        ->required();
    add_frame(s, "--tool", work.tool,
              "the middle of the ferrule's mouth in the flange frame, turned about x, then y, then z (default: "
              "0,0,100,0,0,0); z points along the hair");
    add_frame(s, "--base", work.base, "the model's frame in the robot's base frame, likewise (default: the same)");
    s->add_option_function<std::string>(
         "--holder",
         [&work](const std::string& text) {
             work.holder_mm = numbers(text, 'x', 2, kFarthestMm);
             if (work.holder_mm.empty() || work.holder_mm[0] < 1 || work.holder_mm[1] < 1)
                 throw CLI::ValidationError(
                     "--holder", "'" + excerpt(text) + "' is not DIAMETERxLENGTH in millimetres, each at least 1");
         },
         "holder behind the ferrule's mouth, which must not hit the model: DIAMETERxLENGTH (default: 12x150 mm)")
        ->type_name("DxL");
    s->add_option("--max-speed", work.max_speed_mm,
                  "mm/s of the ferrule (default: 250); strokes are never faster than the hand was")
        ->check(number_in(0.1, 10000));
    s->add_option("--max-acceleration", work.max_acceleration_mm, "mm/s2 of the ferrule (default: 1000)")
        ->check(number_in(1, 100000));
    s->add_option("--max-turn", work.max_turn_deg, "degrees/s of the tool (default: 90)")->check(number_in(0.1, 10000));
    s->add_option("--clearance", work.clearance_mm,
                  "mm of the tip above the surface before and after a stroke (default: 20)")
        ->check(number_in(5, 1000));
    return s;
}

}  // namespace tuft::cli
