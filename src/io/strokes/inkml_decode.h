#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Trace data of InkML 1.0, section 3.2: from characters to numbers.
namespace tuft::io {

struct InkmlChannel {
    std::string name;
    double scale = 1;     ///< to SI; to 0–1 for P
    double offset = 0;    ///< subtracted before scaling, in the file's unit
    double fallback = 0;  ///< SI, where an intermittent channel has not been reported yet
    bool ranged = true;   ///< P and F: the range is known, `scale` brings it to 0–1
};

struct InkmlFormat {
    std::vector<InkmlChannel> channels;  ///< regular ones first
    std::size_t n_regular = 0;

    /// Index of a channel, or -1.
    int find(std::string_view name) const;
};

/// Numbers of a trace, row by row.
struct InkmlRows {
    std::size_t n_channels = 0;
    std::vector<double> values;  ///< [n_rows * n_channels], SI

    std::size_t n_rows() const { return n_channels ? values.size() / n_channels : 0; }
    double at(std::size_t row, int channel) const { return values[row * n_channels + channel]; }
};

/// Decodes `text`. A prefix (! explicit, ' first difference, " second difference) holds for
/// its channel until the next one; `*` goes on as before; `?` and unreported intermittent
/// values keep the last one. Throws `Error(source, line, ...)`, where `text` starts at
/// `first_line` of the source.
InkmlRows decode_inkml(std::string_view text, const InkmlFormat& format, std::size_t max_rows,
                       const std::string& source, long first_line);

}  // namespace tuft::io
