#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <new>

#include "cli/steps/commands.h"
#include "cli/steps/console.h"
#include "core/error.h"
#include "core/system/parallel.h"
#include "core/text/text.h"

namespace {

constexpr std::size_t kLongestMessage = 1000;  // bytes

/// One line on standard error, whatever is in it; where nobody reads that, nothing.
void report_error(const std::string& what) noexcept {
    try {
        fmt::print(stderr, "tuft: {}\n", tuft::excerpt(what, kLongestMessage));
    } catch (const std::exception&) {
    }
}

}  // namespace

int main(int argc, char** argv) {
    using namespace tuft;
    cli::listen_for_signals();
    cli::Command command;
    int status = 0;
    try {
        if (!cli::parse_arguments(argc, argv, command, status)) return status;
        std::visit([](const auto& c) { set_thread_count(c.common.threads); }, command);
        status = std::visit([](const auto& c) { return cli::run(c); }, command);
        std::cout.flush();
        if (!std::cout) throw Error("standard output could not be written to its end");
        return status;
    } catch (const UsageError& error) {
        report_error(error.what());
        return 2;
    } catch (const Cancelled&) {
        report_error("stopped");
    } catch (const std::bad_alloc&) {
        report_error("not enough memory for this; try a smaller atlas or mesh");
    } catch (const std::exception& error) {
        report_error(error.what());
    }
    return 1;
}
