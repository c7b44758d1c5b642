#include "app/document/colours.h"

#include <algorithm>
#include <chrono>
#include <fstream>

#include "app/document/pictures/state_folder.h"
#include "core/error.h"
#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::size_t kRecentColours = 16;
constexpr std::size_t kMostSaved = 200;

fs::path recent_path() {
    return state_folder() / "colours";
}
fs::path saved_folder() {
    return state_folder() / "inks";
}

// A name for a file: what a path would take amiss becomes a dash.
fs::path file_of(const std::string& name) {
    std::string stem = name.substr(0, 100);
    for (char& c : stem)
        if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20) c = '-';
    if (stem.empty() || stem[0] == '.') stem = "-" + stem;
    return saved_folder() / (stem + ".toml");
}

std::optional<ink::ColourMatch> find(const ColourRequest& request) {
    try {
        return ink::match_on_canvas(request.colour, ink::load_substrate(request.substrate), request.held,
                                    {.film = request.film});
    } catch (const Error&) {
        // A project may have a substrate of its own.
        return ink::match_on_canvas(request.colour, ink::load_substrate("porcelain"), request.held,
                                    {.film = request.film});
    }
}

}  // namespace

void MixFinder::request(ColourRequest request) {
    if (running_.valid()) {
        next_ = std::move(request);
        return;
    }
    running_ = std::async(std::launch::async, [request = std::move(request)] { return find(request); });
}

std::optional<ink::ColourMatch> MixFinder::poll() {
    if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    std::optional<ink::ColourMatch> match;
    try {
        match = running_.get();
    } catch (const std::exception&) {
        // Without the shipped pigments there is no mix.
    }
    if (!next_) return match;
    ColourRequest next = std::move(*next_);
    next_.reset();
    request(std::move(next));
    return std::nullopt;
}

std::string pigment_key(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

void load_colours(ColourChoice& choice) {
    std::ifstream in(recent_path());
    for (std::string hex; choice.recent.size() < kRecentColours && in >> hex;)
        if (ink::colour_of_hex(hex)) choice.recent.push_back(hex);
    std::error_code ec;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(saved_folder(), ec))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        if (choice.saved.size() >= kMostSaved) break;
        try {
            choice.saved.push_back(ink::load_ink(file.string()));
        } catch (const Error&) {
            // The others are still there.
        }
    }
}

void remember_colour(ColourChoice& choice, const std::string& hex) {
    std::erase(choice.recent, hex);
    choice.recent.insert(choice.recent.begin(), hex);
    if (choice.recent.size() > kRecentColours) choice.recent.resize(kRecentColours);
    std::string text;
    for (const std::string& one : choice.recent) text += one + "\n";
    try {
        write_file(recent_path(), text.data(), text.size());
    } catch (const Error&) {
        // They hold for this run then.
    }
}

void save_own_ink(ColourChoice& choice, ink::Ink ink) {
    std::error_code ec;
    fs::create_directories(saved_folder(), ec);
    ink.title = ink.name;
    const std::string text = ink::ink_toml(ink);
    write_file(file_of(ink.name), text.data(), text.size());
    std::erase_if(choice.saved, [&](const ink::Ink& other) { return other.name == ink.name; });
    choice.saved.push_back(std::move(ink));
}

void forget_own_ink(ColourChoice& choice, const std::string& name) {
    std::error_code ec;
    fs::remove(file_of(name), ec);
    std::erase_if(choice.saved, [&](const ink::Ink& ink) { return ink.name == name; });
}

}  // namespace tuft::app
