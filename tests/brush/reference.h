#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "paths.h"

/// Rows of a reference table in tests/data/physics, cells by column name.
struct Row {
    std::map<std::string, std::string> cell;
    double operator[](const std::string& name) const { return std::stod(cell.at(name)); }
    const std::string& text(const std::string& name) const { return cell.at(name); }
};

inline std::vector<Row> read_rows(const std::string& name) {
    std::ifstream file(test_data() + "/physics/" + name);
    if (!file) throw std::runtime_error("missing reference table " + name);
    const auto split = [](const std::string& line) {
        std::vector<std::string> cells;
        std::stringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
        return cells;
    };
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> header = split(line);
    std::vector<Row> rows;
    while (std::getline(file, line)) {
        const std::vector<std::string> cells = split(line);
        Row row;
        for (std::size_t i = 0; i < header.size() && i < cells.size(); ++i) {
            row.cell[header[i]] = cells[i];
        }
        rows.push_back(row);
    }
    return rows;
}
