#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

/// Plays the spacenav daemon for one program: protocol 1 of its socket, eight 32-bit words a message.
namespace tuft::test {

class SpaceDaemon {
  public:
    explicit SpaceDaemon(const std::string& path) : path_(path), server_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
        unlink(path.c_str());
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
        if (bind(server_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || listen(server_, 1) != 0)
            throw std::runtime_error("no socket at " + path);
    }
    ~SpaceDaemon() {
        if (client_ >= 0) ::close(client_);
        ::close(server_);
        unlink(path_.c_str());
    }
    SpaceDaemon(const SpaceDaemon&) = delete;
    SpaceDaemon& operator=(const SpaceDaemon&) = delete;

    /// Takes the program in and agrees to what it asks; false when none comes in 60 s.
    bool accept() {
        if (!readable(server_)) return false;
        client_ = ::accept(server_, nullptr, nullptr);
        std::int32_t word = 0;
        // The one word that asks for a protocol; answered with its version.
        if (!readable(client_) || read(client_, &word, sizeof word) != sizeof word || (word & 0xff00) != 0x5500)
            return false;
        send(client_, &word, sizeof word, MSG_NOSIGNAL);
        std::array<std::int32_t, 8> request{};  // for kinds of events
        if (!readable(client_) || read(client_, request.data(), sizeof request) != sizeof request) return false;
        request[7] = 0;
        say(request);
        return true;
    }
    /// Right, up, away from the person, and about them; some 350 counts at most.
    void motion(const std::array<std::int32_t, 6>& counts) {
        say({0, counts[0], counts[1], counts[2], counts[3], counts[4], counts[5], 8});
    }
    void button(std::int32_t number) { say({1, number}); }
    /// A device comes (0) or goes (1).
    void device(std::int32_t what) { say({3, what}); }

  private:
    static bool readable(int fd) {
        pollfd end{fd, POLLIN, 0};
        return poll(&end, 1, 60000) == 1;
    }
    void say(const std::array<std::int32_t, 8>& words) const {
        send(client_, words.data(), sizeof words, MSG_NOSIGNAL);
    }

    std::string path_;
    int server_ = -1, client_ = -1;
};

}  // namespace tuft::test
