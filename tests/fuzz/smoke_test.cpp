#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mutate.h"
#include "paths.h"
#include "targets.h"

namespace tuft::fuzz {
namespace {

std::vector<std::vector<std::uint8_t>> corpus_of(const Target& target) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/tests/fuzz/corpus/" + target.name))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<std::vector<std::uint8_t>> seeds;
    for (const auto& file : files) {
        std::ifstream in(file, std::ios::binary);
        seeds.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return seeds;
}

class Fuzz : public testing::TestWithParam<Target> {};

TEST_P(Fuzz, CorpusAndMutationsAreReadOrRefused) {
    const Target& target = GetParam();
    const auto seeds = corpus_of(target);
    ASSERT_FALSE(seeds.empty());
    for (const auto& seed : seeds) target.run(seed);
    // A crash ends the program: TUFT_FUZZ_LAST names a file that keeps the input it was given.
    const char* last = std::getenv("TUFT_FUZZ_LAST");
    const char* runs = std::getenv("TUFT_FUZZ_RUNS");
    const std::uint64_t n = runs ? std::strtoull(runs, nullptr, 10) : static_cast<std::uint64_t>(target.smoke);
    for (std::uint64_t number = 0; number < n; ++number) {
        const std::vector<std::uint8_t> input = mutated(seeds, number, target.text);
        if (last)
            std::ofstream(last, std::ios::binary | std::ios::trunc)
                .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
        target.run(input);
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace tuft::fuzz
