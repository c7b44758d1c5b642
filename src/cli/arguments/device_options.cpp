#include "cli/arguments/options.h"

namespace tuft::cli {
namespace {

void add_arm(CLI::App* app, DeviceWork& d) {
    app->add_option("--preset", d.arm.preset, "figures of the arm: touch, inverse3 (default), falcon or omega.6")
        ->type_name("ARM");
    app->add_option("--host", d.arm.host, "address of the arm's service (default: 127.0.0.1)");
    app->add_option("--port", d.arm.port, "port of the arm's service (default: 10001)")->check(number_in(0, 65535));
    add_common(app, d.common);
}

void add_hand(CLI::App* app, DeviceWork& d) {
    app->add_option("--simulate", d.arm.simulate,
                    "simulate an arm in a hand, in place of a real one: touch, inverse3, falcon or omega.6")
        ->type_name("ARM");
    app->add_option("--seconds", d.seconds,
                    "seconds that the arm is read (default: 10); the trials of a simulated one come on top")
        ->check(number_in(0.1, 86400));
    app->add_option("--brush", d.brush, "brush in the holder (default: wolf-medium)")->type_name("BRUSH");
    app->add_option("--spine", d.spine,
                    "how the tuft bends: rod (live solve; default: as the brush says) or table (query table)")
        ->check(CLI::IsMember({"rod", "table"}));
    app->add_option("--model", d.model, "model that the brush touches (default: the bowl)");
    app->add_flag("--restore", d.restore,
                  "firm at rest: take the softness of the coupling away; the arm's friction pays");
}

void add_motion(CLI::App* app, DeviceWork& d) {
    app->add_option("--motion", d.simulation.motion, "what the simulated hand does (default: circles)")
        ->check(CLI::IsMember({"press", "press-fast", "drag", "circles", "taps", "rocking", "rest", "hit", "slide"}));
    app->add_option("--follow", d.simulation.follow,
                    "where the simulated hand goes in place of a motion (.csv): columns t,x,y,z or "
                    "t,x,y,z,qw,qx,qy,qz in seconds and metres, or a recording")
        ->excludes("--motion");
}

void add_added_forces(CLI::App* app, DeviceWork& d) {
    app->add_option("--proximity", d.added.proximity,
                    "force on the hand over the last millimetre before the hair touches, in newtons (default: 0)")
        ->check(number_in(0, 0.3));
    app->add_option(
           "--paste", d.added.paste,
           "yield stress in pascals of paste that drags at the hair; heavy oil colour 100 to 1000 (default: 0)")
        ->check(number_in(0, 5000));
}

void add_delay(CLI::App* app, DeviceWork& d) {
    app->add_option("--delay", d.simulation.delay_ms, "delay of a force on its way, in milliseconds (default: 0)")
        ->check(number_in(0, 20));
    app->add_option("--jitter", d.simulation.jitter_ms,
                    "what a force may take longer than the delay, in milliseconds (default: 0.5 with a delay, else 0)")
        ->check(number_in(0, 1));
}

}  // namespace

CLI::App* add_device(CLI::App& app, DeviceWork& d) {
    auto* device = app.add_subcommand("device", "force-feedback arms: list, simulate, test, record");
    device->require_subcommand(1);
    auto* list = device->add_subcommand("list", "print known arms, and whether one answers");
    add_arm(list, d);
    auto* simulate = device->add_subcommand(
        "simulate", "serve a simulated arm in a hand, as the Haply Inverse service does, until it is interrupted");
    add_arm(simulate, d);
    simulate->add_option("--brush", d.brush, "brush that the hand holds (default: wolf-medium)")->type_name("BRUSH");
    simulate->add_option("--model", d.model, "model that the hand paints (default: the bowl)");
    add_motion(simulate, d);
    simulate->add_flag("--hands-off", d.simulation.hands_off, "nobody holds the arm, as 'tuft device test' wants it");
    add_delay(simulate, d);
    simulate
        ->add_option("--fault", d.simulation.fault,
                     "fault of the server, to test a program that is joined to it (default: none)")
        ->check(CLI::IsMember({"none", "dies", "nan", "jumps", "silent", "floods"}));
    simulate
        ->add_option("--fault-after", d.simulation.fault_after,
                     "seconds of a connection after which the fault begins (default: 3)")
        ->check(number_in(0, 86400));
    auto* test = device->add_subcommand("test", "check safety, stability and loop of an arm (hands off), or simulated");
    add_arm(test, d);
    add_hand(test, d);
    test->add_option("--hands", d.trial.hands,
                     "try so many random hands too; an interrupted test prints the figures of those that are done")
        ->check(number_in(0, 1000000));
    test->add_option("--first-hand", d.trial.first_hand,
                     "number of the first random hand, to go on where a test was interrupted (default: 0)")
        ->check(number_in(0, 1000000));
    test->add_option("--hours", d.trial.hours, "try one hand for so many simulated hours too")
        ->check(number_in(0, 100));
    test->add_flag("--all-brushes", d.trial.all_brushes, "all shipped brushes, not only the one of --brush");
    add_delay(test, d);
    add_added_forces(test, d);
    auto* record = device->add_subcommand("record", "record what an arm does and the forces that it is given (.csv)");
    add_arm(record, d);
    add_hand(record, d);
    add_motion(record, d);
    add_added_forces(record, d);
    record->add_option("-o,--output", d.output, "table to write (.csv)")->required();
    record->add_option("--replay", d.replay, "play this recording in place of an arm, and compare the forces (.csv)");
    for (CLI::App* command : {list, simulate, test, record})
        command->callback([&d, command] { d.what = command->get_name(); });
    return device;
}

}  // namespace tuft::cli
