#include "cli/options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/text/text.h"

namespace tuft::cli {

std::optional<double> number_of(const std::string& text) {
    double value = 0;
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto [last, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || last != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

CLI::Validator number_in(double lo, double hi, const std::string& name) {
    return CLI::Validator(
        [lo, hi](std::string& text) -> std::string {
            const std::optional<double> value = number_of(text);
            if (value && *value >= lo && *value <= hi) return {};
            return fmt::format("'{}' is not a number from {:g} to {:g}", excerpt(text), lo, hi);
        },
        name.empty() ? fmt::format("{:g} to {:g}", lo, hi) : name);
}

void add_common(CLI::App* app, Common& c) {
    app->add_option("--threads", c.threads, "threads to use (0: one per core)")->check(number_in(0, 1024));
    app->add_flag("--json", c.json, "print one JSON object on standard output");
    app->add_flag("--quiet", c.quiet, "no progress, no notes");
}

}  // namespace tuft::cli
