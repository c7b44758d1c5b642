#include "io/strokes/inkml_decode.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "core/error.h"

namespace tuft::io {

namespace {

enum class Order { explicit_value, first_difference, second_difference };

/// What a channel remembers from point to point, in the file's unit.
struct History {
    Order order = Order::explicit_value;
    double value = 0, velocity = 0, acceleration = 0;
    int known = 0;  ///< 0 nothing yet, 1 value, 2 velocity too
    bool reported = false;
};

class Decoder {
  public:
    Decoder(std::string_view text, const InkmlFormat& format, std::size_t max_rows, const std::string& source,
            long line)
        : text_(text),
          format_(format),
          max_rows_(max_rows),
          source_(source),
          line_(line),
          history_(format.channels.size()) {}

    InkmlRows run() {
        InkmlRows rows;
        rows.n_channels = format_.channels.size();
        for (skip_space(); at_ < text_.size(); skip_space()) {
            if (rows.n_rows() >= max_rows_) fail(Message("more samples than {}; split the file", max_rows_));
            point(rows);
            if (at_ < text_.size()) ++at_;  // the comma
        }
        return rows;
    }

  private:
    [[noreturn]] void fail(const Message& what) const { throw Error(source_, line_, what); }

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void skip_space() {
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '\n')
                ++line_;
            else if (c != ' ' && c != '\t' && c != '\r')
                return;
        }
    }

    void point(InkmlRows& rows) {
        std::size_t n = 0;
        for (skip_space(); at_ < text_.size() && peek() != ','; skip_space(), ++n) {
            if (n == format_.channels.size())
                fail(Message("a point has more than the {} values of its trace format", n));
            value(history_[n]);
        }
        if (n < format_.n_regular) fail(Message("a point has {} values, its trace format {}", n, format_.n_regular));
        for (std::size_t k = 0; k < history_.size(); ++k) {
            const InkmlChannel& channel = format_.channels[k];
            const History& h = history_[k];
            const double si = h.reported ? (h.value - channel.offset) * channel.scale : channel.fallback;
            if (!std::isfinite(si)) fail(Message("channel {} has a value that is not finite", channel.name));
            rows.values.push_back(si);
        }
    }

    void value(History& h) {
        if (peek() == '!' || peek() == '\'' || peek() == '"') {
            const char prefix = text_[at_++];
            h.order = prefix == '!'    ? Order::explicit_value
                      : prefix == '\'' ? Order::first_difference
                                       : Order::second_difference;
            skip_space();
        }
        switch (peek()) {
            case '*':
                ++at_;
                extrapolate(h);
                return;
            case '?':
                ++at_;
                return;
            case 'T':
                ++at_;
                set(h, 1);
                return;
            case 'F':
                ++at_;
                set(h, 0);
                return;
            default:
                set(h, number());
        }
    }

    void set(History& h, double x) {
        if (h.order == Order::explicit_value) {
            h.value = x;
            h.known = 1;
        } else if (h.order == Order::first_difference) {
            if (h.known < 1) fail("a first difference comes before any explicit value");
            h.velocity = x;
            h.value += x;
            h.known = 2;
        } else {
            if (h.known < 2) fail("a second difference comes before any first difference");
            h.acceleration = x;
            h.velocity += x;
            h.value += h.velocity;
        }
        h.reported = true;
    }

    void extrapolate(History& h) {
        if (h.order == Order::first_difference) {
            h.value += h.velocity;
        } else if (h.order == Order::second_difference) {
            h.velocity += h.acceleration;
            h.value += h.velocity;
        }
    }

    double number() {
        double sign = 1;
        if (peek() == '-' || peek() == '+') {
            if (peek() == '-') sign = -1;
            ++at_;
            skip_space();
        }
        const char* first = text_.data() + at_;
        const char* last = text_.data() + text_.size();
        if (peek() == '#') {
            std::uint64_t bits = 0;
            const auto [end, error] = std::from_chars(first + 1, last, bits, 16);
            if (error != std::errc{}) fail("'#' is not followed by a hexadecimal number");
            at_ = static_cast<std::size_t>(end - text_.data());
            return sign * static_cast<double>(bits);
        }
        double x = 0;
        const auto [end, error] = std::from_chars(first, last, x);
        if (error == std::errc::result_out_of_range) fail("a number is out of range");
        if (error != std::errc{} || *first == '-') fail(not_a_number());
        if (!std::isfinite(x)) fail("a value is not finite");
        at_ = static_cast<std::size_t>(end - text_.data());
        return sign * x;
    }

    std::string not_a_number() const {
        std::string shown;
        for (std::size_t i = at_; i < text_.size() && shown.size() < 16; ++i) {
            const char c = text_[i];
            if (c == ' ' || c == ',' || c == '\n') break;
            shown += c >= ' ' && c < 127 ? c : '?';
        }
        return "'" + shown + "' is not a number";
    }

    std::string_view text_;
    const InkmlFormat& format_;
    std::size_t max_rows_;
    const std::string& source_;
    long line_;
    std::size_t at_ = 0;
    std::vector<History> history_;
};

}  // namespace

int InkmlFormat::find(std::string_view name) const {
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (channels[k].name == name) return static_cast<int>(k);
    return -1;
}

InkmlRows decode_inkml(std::string_view text, const InkmlFormat& format, std::size_t max_rows,
                       const std::string& source, long first_line) {
    return Decoder(text, format, max_rows, source, first_line).run();
}

}  // namespace tuft::io
