#pragma once

#include <string>
#include <vector>

#include "variants/jobs.h"

/// \file
/// Results of all variants as one table and as sheets of pictures.
namespace tuft::variants {

/// A row of the table.
struct Row {
    std::size_t index = 0;
    Task task;
    TaskState state = TaskState::open;
    Figures figures;    ///< where it is done
    std::string fault;  ///< where it failed, or its result is damaged
};

/// One row per task, in the order of the tasks. Throws `Error` for a folder that is damaged.
std::vector<Row> gather(const Jobs& jobs);

/// The table as CSV (RFC 4180) and as JSON. Where two runs did the same, all but `seconds` is the same.
std::string csv_of(const Jobs& jobs, const std::vector<Row>& rows);
std::string json_of(const Jobs& jobs, const std::vector<Row>& rows);

/// Writes the pictures that there are of done variants with their names, up to 60 a sheet: contact-sheet-01.png, …
/// Returns the files. Throws `Error` for pictures that cannot be read.
std::vector<std::filesystem::path> write_contact_sheets(const Jobs& jobs, const std::vector<Row>& rows,
                                                        const ProgressFn& progress = {});

}  // namespace tuft::variants
