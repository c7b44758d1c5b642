#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <new>

#include "cli/commands.h"
#include "core/error.h"
#include "core/parallel.h"

int main(int argc, char** argv) {
    using namespace tuft;
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
        fmt::print(stderr, "tuft: {}\n", error.what());
        return 2;
    } catch (const Cancelled&) {
        fmt::print(stderr, "tuft: stopped\n");
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "tuft: not enough memory for this; try a smaller atlas or mesh\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "tuft: {}\n", error.what());
    }
    return 1;
}
