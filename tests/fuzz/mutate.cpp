#include "mutate.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

#include "core/random.h"

namespace tuft::fuzz {
namespace {

constexpr std::size_t kLongest = 65536;
constexpr std::string_view kNumbers[] = {"nan",
                                         "inf",
                                         "-1",
                                         "0",
                                         "1e39",
                                         "1e300",
                                         "-1e308",
                                         "1e-46",
                                         "1e-320",
                                         "4294967295",
                                         "4294967296",
                                         "2147483648",
                                         "-2147483649",
                                         "9223372036854775808",
                                         "18446744073709551616",
                                         "1e10",
                                         "1e7",
                                         "1e4",
                                         "0.5",
                                         "255",
                                         "256",
                                         "65536"};
constexpr std::string_view kWords[] = {"\n",
                                       " ",
                                       "\r",
                                       "\t",
                                       "\\\n",
                                       "#",
                                       "/",
                                       "//",
                                       "\"",
                                       "'",
                                       "[",
                                       "]",
                                       "{",
                                       "}",
                                       "<",
                                       ">",
                                       "&",
                                       "=",
                                       ".",
                                       ",",
                                       "-",
                                       "\xff\xfe",
                                       "T\xfcr",
                                       "end_header\n",
                                       "property list uchar int vertex_indices\n",
                                       "format binary_big_endian 1.0\n",
                                       "f 1 -1 2\n",
                                       "usemtl a\n",
                                       "solid",
                                       "endsolid",
                                       "STNCOFF",
                                       "<use href='#a'/>",
                                       "<g>",
                                       "</g>",
                                       " transform='scale(1e9)'",
                                       "M0 0A1 1 0 0 1 ",
                                       "<traceGroup>",
                                       "</traceGroup>",
                                       "contextRef='#c'",
                                       "[[pigment]]\n",
                                       "a.b.c.d=1\n",
                                       "\"matrix\":[1]",
                                       "\"children\":[0]",
                                       "\"bufferView\":9",
                                       "\"byteOffset\":4294967295"};

class Mutator {
  public:
    Mutator(const std::vector<std::vector<std::uint8_t>>& seeds, std::uint64_t number)
        : seeds_(seeds), random_(number + 1) {}

    std::vector<std::uint8_t> run(bool text) {
        bytes_ = seeds_[below(seeds_.size())];
        const std::size_t edits = 1 + below(5);
        for (std::size_t e = 0; e < edits; ++e) {
            const std::size_t kind = below(text ? 10 : 7);
            if (kind < 7)
                edit_bytes(kind);
            else if (kind < 9)
                replace_number();
            else
                insert(pick(kWords));
        }
        if (bytes_.size() > kLongest) bytes_.resize(kLongest);
        return std::move(bytes_);
    }

  private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random_.bits() % n); }
    template <std::size_t N>
    std::string_view pick(const std::string_view (&words)[N]) {
        return words[below(N)];
    }

    std::vector<std::uint8_t>::iterator at(std::size_t i) { return bytes_.begin() + static_cast<std::ptrdiff_t>(i); }
    void insert(std::string_view word) { bytes_.insert(at(below(bytes_.size() + 1)), word.begin(), word.end()); }

    void edit_bytes(std::size_t kind) {
        if (bytes_.empty()) return insert(pick(kWords));
        const std::size_t place = below(bytes_.size());
        const std::size_t most = bytes_.size() - place,
                          length = 1 + below(std::min<std::size_t>(most, below(4) ? 16 : 4096));
        switch (kind) {
            case 0:
                bytes_[place] = static_cast<std::uint8_t>(random_.bits());
                break;
            case 1:
                bytes_[place] = static_cast<std::uint8_t>(bytes_[place] ^ (1u << below(8)));
                break;
            case 2:
                bytes_.erase(at(place), at(std::min(place + length, bytes_.size())));
                break;
            case 3: {
                const std::vector<std::uint8_t> part(at(place), at(std::min(place + length, bytes_.size())));
                const std::size_t to = below(bytes_.size() + 1);
                for (std::size_t n = 1 + (below(8) == 0 ? below(64) : 0); n > 0 && bytes_.size() < kLongest; --n)
                    bytes_.insert(at(to), part.begin(), part.end());
                break;
            }
            case 4: {
                const std::vector<std::uint8_t>& other = seeds_[below(seeds_.size())];
                if (other.empty()) break;
                const std::size_t from = below(other.size()),
                                  n = 1 + below(std::min<std::size_t>(other.size() - from, 64));
                const auto first = other.begin() + static_cast<std::ptrdiff_t>(from);
                bytes_.insert(at(place), first, first + static_cast<std::ptrdiff_t>(n));
                break;
            }
            case 5:
                for (std::size_t i = 0; i < std::min<std::size_t>(most, std::size_t{1} << below(4)); ++i)
                    bytes_[place + i] = below(2) ? 0xff : 0;
                break;
            default:
                bytes_.resize(place);
                break;
        }
    }

    /// Puts a number at the edge in place of one that is there.
    void replace_number() {
        if (bytes_.empty()) return;
        const auto digit = [](std::uint8_t c) { return std::isdigit(c) != 0; };
        const auto begin = std::find_if(at(below(bytes_.size())), bytes_.end(), digit);
        const auto end =
            std::find_if_not(begin, bytes_.end(), [&](std::uint8_t c) { return digit(c) || c == '.' || c == 'e'; });
        const std::string_view number = pick(kNumbers);
        const auto where = bytes_.erase(begin, end);
        bytes_.insert(where, number.begin(), number.end());
    }

    const std::vector<std::vector<std::uint8_t>>& seeds_;
    Random random_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::vector<std::uint8_t> mutated(const std::vector<std::vector<std::uint8_t>>& seeds, std::uint64_t number,
                                  bool text) {
    return Mutator(seeds, number).run(text);
}

}  // namespace tuft::fuzz
