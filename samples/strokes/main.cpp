#include <fmt/format.h>

#include <filesystem>

#include "compositions.h"
#include "core/error.h"
#include "io/strokes/inkml.h"

using namespace tuft;

/// tuft-strokes FOLDER: writes the sample stroke files.
int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: tuft-strokes FOLDER\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        const auto save = [&](const char* name, const char* title, const std::vector<stroke::RecordedStroke>& traces) {
            double seconds = 0;
            for (const stroke::RecordedStroke& t : traces) seconds += t.samples.back().time;
            io::write_inkml(folder / name, traces, title, io::Digits::rounded);
            fmt::print("{}: {} strokes, {:.0f} s\n", name, traces.size(), seconds);
        };
        save("qi-shang-ba-xia.inkml", "七上八下", samples::bowl_inside());
        save("man-bu-ren-sheng.inkml", "漫步人生", samples::bowl_outside());
        save("plate-ornament.inkml", "Leaves on a winding stem", samples::plate_ornament());
        save("stroke-sheet.inkml", "Strokes of wolf, goat and mixed hair", samples::stroke_sheet());
        save("wet-sheet.inkml", "Wet ink", samples::wet_sheet());
        save("wet-bowl.inkml", "Wet in wet", samples::wet_bowl());
        save("backrun.inkml", "Water into a half-dry wash", samples::backrun());
        save("wet-vase.inkml", "Ink that runs down", samples::wet_vase());
        save("vase-plum.inkml", "Plum blossom", samples::vase_plum());
        save("blue-and-white.inkml", "A peony in underglaze blue", samples::blue_and_white());
        save("impasto.inkml", "Thick paint", samples::impasto());
        save("car-pinstripe.inkml", "Pinstripes", samples::car_pinstripe());
    } catch (const Error& e) {
        fmt::print(stderr, "tuft-strokes: {}\n", e.what());
        return 1;
    }
    return 0;
}
