#include "io/image/film_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "core/files/system_message.h"
#include "core/system/interrupt.h"

extern char** environ;

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

/// The program on $PATH; empty: it is not installed.
fs::path find_ffmpeg() {
    const char* listed = std::getenv("PATH");
    std::istringstream folders(listed ? listed : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::path(folder.empty() ? "." : folder) / "ffmpeg";
        if (::access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

fs::path frame_path(const fs::path& folder, int number) {
    return folder / fmt::format("frame-{:05}.png", number);
}

/// Holds the content of a film while its frames are written.
fs::path unfinished_path(const fs::path& folder) {
    return folder / "unfinished-film.txt";
}

/// Frames in a folder; they are removed where this is left before `finish` or `keep`.
class FrameFolder : public FilmSink {
  public:
    FrameFolder(fs::path folder, const std::string& content) : folder_(std::move(folder)) {
        std::error_code ec;
        made_ = fs::create_directory(folder_, ec);
        if (!fs::is_directory(folder_, ec)) throw Error(folder_.string(), "cannot be made");
        const fs::path unfinished = unfinished_path(folder_);
        if (fs::exists(unfinished, ec)) {
            const std::vector<char> former = read_file(unfinished, kMostContent);
            if (content.empty() || std::string_view(former.data(), former.size()) != content)
                throw Error(folder_.string(), "has frames of another film, which was stopped; name another folder");
            while (fs::exists(frame_path(folder_, there_ + 1), ec)) ++there_;
            for (const auto& entry : fs::directory_iterator(folder_, ec))  // of the frame that was being written
                if (entry.path().filename().string().starts_with(".frame-")) fs::remove(entry.path(), ec);
        } else if (!content.empty()) {
            try {
                write_file(unfinished, content.data(), content.size());
            } catch (...) {
                remove();
                throw;
            }
        }
    }
    ~FrameFolder() override {
        if (!kept_) remove();
    }
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    bool has_next() const override { return count_ < there_; }
    void pass() override { ++count_; }
    void add(const PixelView& frame) override { write_image(frame_path(folder_, ++count_), frame); }
    /// What is there stays, and is continued by the next film of this content.
    void keep() { kept_ = std::max(count_, there_) > 0; }
    void finish() {
        std::error_code ec;
        fs::remove(unfinished_path(folder_), ec);
        kept_ = true;
    }

  private:
    static constexpr std::size_t kMostContent = std::size_t{1} << 20;  // bytes

    void remove() noexcept {
        std::error_code ec;
        for (int k = 1; k <= std::max(count_, there_); ++k) fs::remove(frame_path(folder_, k), ec);
        fs::remove(unfinished_path(folder_), ec);
        if (made_) fs::remove(folder_, ec);
    }

    fs::path folder_;
    int count_ = 0, there_ = 0;  ///< given so far; in the folder from before
    bool made_ = false, kept_ = false;
};

std::vector<std::string> ffmpeg_arguments(const fs::path& program, const fs::path& output, const FilmFormat& format) {
    std::vector<std::string> a{program.string(),
                               "-hide_banner",
                               "-loglevel",
                               "error",
                               "-xerror",  // else a full disk at the end of the file is no failure
                               "-y",
                               "-f",
                               "rawvideo",
                               "-pix_fmt",
                               "rgb24",
                               "-s",
                               fmt::format("{}x{}", format.width, format.height),
                               "-r",
                               fmt::format("{:g}", format.frames_per_second),
                               "-i",
                               "pipe:0"};
    const std::vector<std::string> gif{"-vf", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1",
                                       "-f", "gif"};
    // One thread: x264 with several gives other bits.
    const std::vector<std::string> mp4{"-vf",
                                       "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
                                       "-c:v",
                                       "libx264",
                                       "-threads",
                                       "1",
                                       "-preset",
                                       "fast",
                                       "-crf",
                                       "18",
                                       "-pix_fmt",
                                       "yuv420p",
                                       "-colorspace",
                                       "bt709",
                                       "-color_primaries",
                                       "bt709",
                                       "-color_trc",
                                       "iec61966-2-1",
                                       "-movflags",
                                       "+faststart",
                                       "-f",
                                       "mp4"};
    const std::vector<std::string>& more = lower_extension(output) == ".gif" ? gif : mp4;
    a.insert(a.end(), more.begin(), more.end());
    a.push_back("file:" + output.string());
    return a;
}

/// A started ffmpeg and the pipe to it; it is ended where this is left before `finish`.
class FilmPipe : public FilmSink {
  public:
    FilmPipe(const fs::path& output, const FilmFormat& format) : format_(format) {
        const fs::path program = find_ffmpeg();
        if (program.empty()) throw Error("ffmpeg", "is not installed");
        std::vector<std::string> words = ffmpeg_arguments(program, output, format);
        std::vector<char*> arguments;
        arguments.reserve(words.size() + 1);
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw Error("ffmpeg", Message("no pipe: {}", system_message(errno)));
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, ends[0], 0);
        posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
        // A process group of its own: Ctrl-C reaches this process alone, which then ends the other.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        posix_spawnattr_setpgroup(&attributes, 0);
        const int failed = posix_spawn(&pid_, program.c_str(), &files, &attributes, arguments.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        ::close(ends[0]);
        pipe_ = ends[1];
        if (failed) {
            pid_ = 0;
            ::close(pipe_);
            throw Error(program.string(), Message("cannot be started: {}", system_message(failed)));
        }
    }
    ~FilmPipe() override { end(); }
    FilmPipe(const FilmPipe&) = delete;
    FilmPipe& operator=(const FilmPipe&) = delete;

    void add(const PixelView& frame) override {
        const std::size_t row = 3 * static_cast<std::size_t>(format_.width);
        for (int y = 0; y < format_.height; ++y)
            write_all(static_cast<const char*>(frame.first) + y * frame.row_bytes, row);
    }

    /// Waits until ffmpeg has written the file.
    void finish() {
        ::close(pipe_);
        pipe_ = -1;
        int status = 0;
        while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) check_interrupt();
        pid_ = 0;
        if (status != 0) fail();
    }

  private:
    [[noreturn]] static void fail() { throw Error("ffmpeg", "did not write the film (disk full? no libx264?)"); }

    void write_all(const char* bytes, std::size_t n) const {
        while (n > 0) {
            const ssize_t wrote = ::write(pipe_, bytes, n);
            if (wrote < 0 && errno == EINTR) {
                check_interrupt();
                continue;
            }
            if (wrote <= 0) fail();
            bytes += wrote;
            n -= static_cast<std::size_t>(wrote);
        }
    }

    void end() noexcept {
        if (pid_ > 0) {
            ::kill(-pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        if (pipe_ >= 0) ::close(pipe_);
        pid_ = 0;
        pipe_ = -1;
    }

    FilmFormat format_;
    pid_t pid_ = 0;
    int pipe_ = -1;
};

/// A pipe whose reader has ended gives an error, not a signal, while this lives.
class NoPipeSignal {
  public:
    NoPipeSignal() {
        struct sigaction ignore {};
        ignore.sa_handler = SIG_IGN;
        ::sigaction(SIGPIPE, &ignore, &before_);
    }
    ~NoPipeSignal() { ::sigaction(SIGPIPE, &before_, nullptr); }
    NoPipeSignal(const NoPipeSignal&) = delete;
    NoPipeSignal& operator=(const NoPipeSignal&) = delete;

  private:
    struct sigaction before_ {};
};

}  // namespace

bool is_film_file(const fs::path& path) {
    return lower_extension(path) == ".mp4" || lower_extension(path) == ".gif";
}

void check_film(const fs::path& path) {
    std::error_code ec;
    if (!is_film_file(path)) {
        if (fs::exists(frame_path(path, 1), ec) && !fs::exists(unfinished_path(path), ec))
            throw Error(path.string(), "has the frames of a film already (frame-00001.png)");
        return;
    }
    if (find_ffmpeg().empty())
        throw Error(path.string(), "needs the program ffmpeg, which is not installed; name a folder to get the frames");
}

void write_film(const fs::path& path, const FilmFormat& format, const std::function<void(FilmSink& sink)>& draw) {
    if (!is_film_file(path)) {
        FrameFolder folder(path, format.content);
        try {
            draw(folder);
        } catch (const Cancelled&) {
            if (!format.content.empty()) folder.keep();
            throw;
        }
        return folder.finish();
    }
    write_atomically(path, [&](const fs::path& temporary) {
        const NoPipeSignal quiet;
        FilmPipe pipe(temporary, format);
        draw(pipe);
        pipe.finish();
    });
}

}  // namespace tuft::io
