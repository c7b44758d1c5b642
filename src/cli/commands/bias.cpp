#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/files/files.h"
#include "core/text/counted.h"
#include "io/strokes/inkml.h"
#include "stroke/gesture/bias_correction.h"

namespace tuft::cli {

int run(const BiasCorrection& a) {
    check_extension(a.output, {".toml"});
    check_output(a.output);
    const std::vector<stroke::RecordedStroke> intended = io::read_inkml(a.intended),
                                              written = io::read_inkml(a.written);
    stroke::BiasCorrection bias;
    try {
        bias = stroke::learn_bias(intended, written);
    } catch (const Error& error) {
        throw Error(a.written.string(), error.what());
    }
    const std::string toml = stroke::bias_toml(bias);
    write_file(a.output, toml.data(), toml.size());
    double ratio = 0;
    for (const stroke::BiasPiece& p : bias.pieces)
        for (const double r : p.pressure_ratio) ratio += r / (4.0 * static_cast<double>(bias.pieces.size()));
    const glm::dmat2& m = bias.linear;
    if (a.common.json)
        print_json(nlohmann::json{{"wrote", a.output.string()},
                                  {"strokes", written.size()},
                                  {"pieces", bias.pieces.size()},
                                  {"pressure_ratio", ratio},
                                  {"linear", {{m[0][0], m[1][0]}, {m[0][1], m[1][1]}}}});
    else
        fmt::print("wrote {}: {} in {}; mean pressure x {:.2f}, slant {:+.2f}, width x {:.2f}, height x {:.2f}\n",
                   a.output.string(), counted(written.size(), "stroke"), counted(bias.pieces.size(), "piece"), ratio,
                   m[1][0], m[0][0], m[1][1]);
    return 0;
}

}  // namespace tuft::cli
