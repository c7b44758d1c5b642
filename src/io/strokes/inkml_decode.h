#pragma once

#include <string>
#include <string_view>
#include <vector>

/// \file
/// Decoding of InkML trace data (InkML 1.0, section 3.2). Called by inkml.cpp only. Any thread.
namespace tuft::io {

/// A channel of a trace format.
struct InkmlChannel {
    std::string name;
    double scale = 1;     ///< from the file's unit to SI; to 0–1 for P
    double offset = 0;    ///< subtracted before scaling, in the file's unit
    double fallback = 0;  ///< SI, value of an intermittent channel before its first report
    bool ranged = true;   ///< P and F: the range is declared, `scale` maps it to 0–1
};

/// Channels of a trace format in file order.
struct InkmlFormat {
    std::vector<InkmlChannel> channels;  ///< regular ones first
    std::size_t n_regular = 0;

    /// Returns the index of a channel, or −1.
    int find(std::string_view name) const;
};

/// Values of a trace, row by row.
struct InkmlRows {
    std::size_t n_channels = 0;
    std::vector<double> values;  ///< [n_rows * n_channels], SI

    std::size_t n_rows() const { return n_channels ? values.size() / n_channels : 0; }
    double at(std::size_t row, int channel) const { return values[row * n_channels + channel]; }
};

/// Decodes `text`. A prefix (! explicit, ' first difference, " second difference) holds for its channel until the next
/// prefix. `*` continues the previous difference. `?` and unreported intermittent channels repeat the previous value.
/// Throws `Error(source, line, ...)`; `text` begins at line `first_line` of the source.
InkmlRows decode_inkml(std::string_view text, const InkmlFormat& format, std::size_t max_rows,
                       const std::string& source, long first_line);

}  // namespace tuft::io
