#include "variants/jobs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/system_message.h"
#include "core/files/text_file.h"
#include "core/system/interrupt.h"
#include "core/text/nesting.h"
#include "core/text/text.h"
#include "io/image/image.h"

namespace fs = std::filesystem;

namespace tuft::variants {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figures, canvas_hash, ink_area_mm2, ink_mm3, strokes, dry, mismatches, unconverged,
                                   seconds, view_deg, substrate)

namespace {

constexpr const char* kFormat = "tuft variants 1";
constexpr std::size_t kMaxJson = std::size_t{64} << 20, kMaxResult = std::size_t{1} << 30;
constexpr const char *kResult = "result.json", *kCoverage = "coverage.bin", *kPicture = "picture.png";

nlohmann::json json_of_file(const fs::path& file) {
    const std::string text = read_text(file, kMaxJson);
    check_json_nesting(text, file.string());
    nlohmann::json j = nlohmann::json::parse(text, nullptr, false);
    if (!j.is_object()) throw Error(file.string(), "is damaged");
    return j;
}

void make_folder(const fs::path& folder) {
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (ec) throw Error(folder.string(), Message("the folder cannot be made: {}", system_message(ec)));
}

bool is_hash(const std::string& text) {
    return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string task_name(std::size_t i) {
    return fmt::format("{:06}.json", i);
}

}  // namespace

TaskLock::~TaskLock() {
    if (file_ >= 0) ::close(file_);
}

Jobs::Jobs(const fs::path& folder) : folder_(folder) {
    const fs::path file = folder / "plan.json";
    std::error_code ec;
    if (!fs::exists(file, ec)) throw Error(folder.string(), "is no folder of 'tuft variants': it has no plan.json");
    try {
        const nlohmann::json j = json_of_file(file);
        if (j.at("format") != kFormat) throw Error(file.string(), "is of another version of tuft");
        name_ = j.at("name").get<std::string>();
        plan_folder_ = j.at("folder").get<std::string>();
        j.at("hashes").get_to(hashes_);
    } catch (const nlohmann::json::exception&) {
        throw Error(file.string(), "is damaged; write the tasks again");
    }
    if (hashes_.empty() || hashes_.size() > kMostTasks || !std::all_of(hashes_.begin(), hashes_.end(), is_hash))
        throw Error(file.string(), "is damaged; write the tasks again");
}

fs::path Jobs::task_file(std::size_t i) const {
    return folder_ / "tasks" / task_name(i);
}
fs::path Jobs::result_folder(std::size_t i) const {
    return folder_ / "results" / hashes_[i];
}
fs::path Jobs::failure_file(std::size_t i) const {
    return folder_ / "results" / (hashes_[i] + ".failed");
}
fs::path Jobs::picture(std::size_t i) const {
    return result_folder(i) / kPicture;
}

Task Jobs::task(std::size_t i) const {
    const fs::path file = task_file(i);
    const Task task = task_of_json(read_text(file, kMaxJson), file.string());
    if (hash_of(task) != hashes_[i]) throw Error(file.string(), "was changed; write the tasks again");
    return task;
}

TaskState Jobs::state(std::size_t i) const {
    std::error_code ec;
    if (fs::exists(result_folder(i) / kResult, ec)) return TaskState::done;
    return fs::exists(failure_file(i), ec) ? TaskState::failed : TaskState::open;
}

std::optional<TaskLock> Jobs::lock(std::size_t i) const {
    const fs::path path = task_file(i);
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw Error(path.string(), Message("cannot be opened: {}", system_message(errno)));
    TaskLock lock(file);
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return lock;
    if (errno == EWOULDBLOCK) return {};
    throw Error(path.string(), Message("cannot be locked where it lies: {}", system_message(errno)));
}

void Jobs::store(std::size_t i, const Outcome& outcome) const {
    const fs::path place = result_folder(i), beside = folder_ / "results" / ("." + hashes_[i] + ".part");
    std::error_code ec;
    fs::remove_all(beside, ec);
    make_folder(beside);
    const Unfinished unfinished(beside);
    const std::vector<char> coverage = bytes_of(outcome.coverage);
    write_file(beside / kCoverage, coverage.data(), coverage.size());
    nlohmann::json j = outcome.figures;
    j["files"][kCoverage] = content_hash(beside / kCoverage);
    if (const render::Image& image = outcome.picture; image.width > 0) {
        io::write_image(beside / kPicture, io::view_of(image.width, image.height, 3, image.rgb.data()));
        j["files"][kPicture] = content_hash(beside / kPicture);
    }
    write_text(beside / kResult, j.dump(1) + "\n");
    if (::rename(beside.c_str(), place.c_str()) != 0) {
        const int fault = errno;
        fs::remove_all(beside, ec);
        if (state(i) != TaskState::done)
            throw Error(place.string(), Message("cannot be written: {}", system_message(fault)));
    }
    fs::remove(failure_file(i), ec);
}

void Jobs::store_failure(std::size_t i, const std::string& why) const {
    write_text(failure_file(i), excerpt(why, 1000) + "\n");
}
void Jobs::forget_failure(std::size_t i) const {
    std::error_code ec;
    fs::remove(failure_file(i), ec);
}
std::string Jobs::failure(std::size_t i) const {
    const std::string text = read_text(failure_file(i), kMaxJson);
    return excerpt(text.substr(0, text.find('\n')), 1000);
}

std::vector<char> Jobs::checked_file(std::size_t i, const char* name) const {
    const fs::path file = result_folder(i) / name;
    const nlohmann::json j = json_of_file(result_folder(i) / kResult);
    if (!j.contains("files") || j["files"].value(name, "") != content_hash(file))
        throw Error(file.string(), "is damaged");
    return read_file(file, kMaxResult);
}

Figures Jobs::figures(std::size_t i) const {
    const fs::path file = result_folder(i) / kResult;
    try {
        const auto figures = json_of_file(file).get<Figures>();
        if (figures.view_deg.size() != 2) throw Error(file.string(), "is damaged");
        return figures;
    } catch (const nlohmann::json::exception&) {
        throw Error(file.string(), "is damaged");
    }
}

Coverage Jobs::coverage(std::size_t i) const {
    return coverage_of_bytes(checked_file(i, kCoverage), (result_folder(i) / kCoverage).string());
}

bool Jobs::has_picture(std::size_t i) const {
    return json_of_file(result_folder(i) / kResult).value("files", nlohmann::json::object()).contains(kPicture);
}

bool Jobs::remove_damaged(std::size_t i) const {
    if (state(i) != TaskState::done) return false;
    try {
        figures(i);
        coverage(i);
        if (has_picture(i)) checked_file(i, kPicture);
        return false;
    } catch (const Error&) {
    } catch (const nlohmann::json::exception&) {
    }
    const auto mine = lock(i);
    if (!mine) return false;
    std::error_code ec;
    fs::remove_all(result_folder(i), ec);
    return true;
}

Jobs lay_out(const Plan& plan, const std::vector<Task>& tasks, const fs::path& folder) {
    std::error_code ec;
    if (!fs::exists(folder / "plan.json", ec))
        for (const auto& entry : fs::directory_iterator(folder, ec))  // one that was stopped here has these two
            if (entry.path().filename() != "tasks" && entry.path().filename() != "results")
                throw Error(folder.string(), "is neither empty nor a folder of 'tuft variants'");
    for (const char* part : {"tasks", "results"}) make_folder(folder / part);
    nlohmann::json j{{"format", kFormat}, {"name", plan.name}, {"folder", plan.folder.string()}};
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        write_text(folder / "tasks" / task_name(i), json_of(tasks[i]));
        j["hashes"].push_back(hash_of(tasks[i]));
    }
    write_text(folder / "plan.json", j.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    for (std::size_t i = tasks.size(); fs::remove(folder / "tasks" / task_name(i), ec); ++i) {
    }
    return Jobs(folder);
}

TaskResult run_task(const Jobs& jobs, std::size_t i, const PaintTask& paint, ContentHashes& known) {
    if (jobs.state(i) == TaskState::done) return TaskResult::done_before;
    const auto mine = jobs.lock(i);
    if (!mine) return TaskResult::taken;
    if (jobs.state(i) == TaskState::done) return TaskResult::done_before;
    try {
        const Task task = jobs.task(i);
        if (task.program != program_version())
            throw Error("the task is for another version of tuft; write the tasks again");
        for (const auto& [name, hash] : contents_of(task, jobs.plan_folder(), known))
            if (const auto at = task.contents.find(name); at == task.contents.end() || at->second != hash)
                throw Error(fmt::format("'{}' has changed since the tasks were written; write them again", name));
        jobs.store(i, paint(task));
        return TaskResult::painted;
    } catch (const UsageError& error) {
        jobs.store_failure(i, error.what());
    } catch (const Error& error) {
        jobs.store_failure(i, error.what());
    }
    return TaskResult::failed;
}

}  // namespace tuft::variants
