#include "cli/commands/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/text/text.h"
#include "stroke/journal/tables.h"

/// `tuft part`, and what other commands take of parts.
namespace tuft::cli {
namespace {

using Names = std::vector<std::string>;

/// "PART=NAME" as a pair. A part's name may hold '='.
std::pair<std::string, std::string> part_and_substrate(const std::string& text) {
    const auto equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw UsageError("'" + excerpt(text) + "' is not PART=SUBSTRATE, such as Window=glass");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

/// The table with changes one after the other; the sum of them as an edit.
class PartChanges {
  public:
    PartChanges(const stroke::PartTable& table, const mesh::TriangleMesh& mesh)
        : before_(table), table_(table), all_(stroke::part_names(mesh)), mesh_(mesh) {}

    const stroke::PartTable& table() const { return table_; }
    const Names& all() const { return all_; }

    void hide(const Names& names, bool hidden) { apply(names, stroke::hidden_parts(table_, names, hidden)); }
    void lock(const Names& names, bool locked) { apply(names, stroke::locked_parts(table_, names, locked)); }
    void isolate(const Names& names) { apply(names, stroke::isolated_parts(table_, all_, names)); }
    /// "none": the project's substrate.
    void set_substrate(const std::string& part, const std::string& substrate) {
        std::optional<ink::Substrate> own;
        if (substrate != "none") own = ink::load_substrate(substrate);
        apply({part}, stroke::parts_of_substrate(table_, {part}, own));
    }

    std::vector<stroke::PartEdit> edits() const {
        stroke::PartEdit edit;
        for (const std::string& name : all_) edit.parts.push_back(table_.state_of(name));
        edit = stroke::changes_only(before_, std::move(edit));
        if (edit.parts.empty()) return {};
        return {std::move(edit)};
    }

  private:
    void apply(const Names& names, const stroke::PartEdit& edit) {
        stroke::check_part_names(mesh_, names);
        if (!edit.parts.empty()) stroke::apply(table_, edit);
    }

    stroke::PartTable before_, table_;
    Names all_;
    const mesh::TriangleMesh& mesh_;
};

nlohmann::json to_json(const stroke::Part& part, const std::string& document) {
    return {{"name", part.name},
            {"visible", !part.hidden},
            {"locked", part.locked},
            {"substrate", part.substrate ? part.substrate->name : document},
            {"own_substrate", part.substrate.has_value()}};
}

void change(const PartWork& a, PartChanges& changes) {
    Names names(a.names.begin(), a.names.end());
    if (a.what == "substrate") {
        if (names.empty()) throw UsageError("'tuft part PROJECT substrate' needs PART=SUBSTRATE");
        for (const std::string& text : names) {
            const auto [part, substrate] = part_and_substrate(text);
            changes.set_substrate(part, substrate);
        }
        return;
    }
    if (names.empty() && (a.what == "isolate" || a.what == "hide"))
        throw UsageError("'tuft part PROJECT " + a.what + "' needs the name of a part");
    if (names.empty()) names = changes.all();
    if (a.what == "show" || a.what == "hide") changes.hide(names, a.what == "hide");
    if (a.what == "lock" || a.what == "unlock") changes.lock(names, a.what == "lock");
    if (a.what == "isolate") changes.isolate(names);
}

}  // namespace

std::vector<stroke::PartEdit> part_edits(const PartChoice& choice, const stroke::PartTable& table,
                                         const mesh::TriangleMesh& mesh) {
    PartChanges changes(table, mesh);
    if (!choice.only.empty()) changes.isolate(choice.only);
    if (!choice.hide.empty()) changes.hide(choice.hide, true);
    if (!choice.lock.empty()) changes.lock(choice.lock, true);
    for (const std::string& text : choice.substrates) {
        const auto [part, substrate] = part_and_substrate(text);
        changes.set_substrate(part, substrate);
    }
    return changes.edits();
}

VisibleParts::VisibleParts(stroke::Model& model, const stroke::PartTable& table) : model_(model) {
    stroke::PartSet parts(model);
    parts.set_table(table);
    const std::vector<std::uint8_t> hidden = parts.hidden_triangles();
    if (hidden.empty()) return;
    std::vector<std::uint32_t> visible;
    for (std::uint32_t t = 0; t < hidden.size(); ++t)
        if (!hidden[t]) visible.push_back(t);
    if (visible.empty()) throw Error("all parts of the model are hidden (see 'tuft part show', --only-parts)");
    whole_ = std::exchange(model_.query, std::make_unique<mesh::SurfaceQuery>(*model.mesh, std::move(visible)));
}

VisibleParts::~VisibleParts() {
    if (whole_) model_.query = std::move(whole_);
}

int run(const PartWork& a) {
    Console console(a.common.quiet);
    const bool reads = a.what == "list";
    io::Project project =
        io::Project::open(a.project, open_options(reads ? io::Access::read : io::Access::write, console));
    const std::vector<stroke::JournalEntry> entries = project.strokes();
    const io::ProjectModel model = project.model();
    const std::string document = ink::parse_substrate(model.substrate, a.project.string()).name;
    PartChanges changes(stroke::parts_after(entries), model.mesh);
    if (changes.all().empty()) throw Error(a.project.string(), "the model's file names no parts");
    change(a, changes);
    for (stroke::PartEdit& edit : changes.edits()) project.append(stroke::entry_after(entries, std::move(edit)));
    Names listed = changes.all();
    if (reads && !a.names.empty()) {
        listed.assign(a.names.begin(), a.names.end());
        stroke::check_part_names(model.mesh, listed);
    }
    if (a.common.json) {
        nlohmann::json j{{"project", a.project.string()}, {"parts", nlohmann::json::array()}};
        for (const std::string& name : listed) j["parts"].push_back(to_json(changes.table().state_of(name), document));
        print_json(j);
        return 0;
    }
    for (const std::string& name : listed) {
        const stroke::Part part = changes.table().state_of(name);
        fmt::print("{}{}{}{}\n", name, part.hidden ? " (hidden)" : "", part.locked ? " (locked)" : "",
                   part.substrate ? ", " + part.substrate->name : "");
    }
    return 0;
}

}  // namespace tuft::cli
