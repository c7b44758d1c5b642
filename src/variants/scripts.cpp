#include "variants/scripts.h"

#include <fmt/format.h>

#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft::variants {
namespace {

constexpr std::size_t kMostInArray = 1000;

/// A word of the shell, whatever is in it.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

/// A text of YAML in double quotes.
std::string yaml_text(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
}

void write_text(const fs::path& file, const std::string& text, bool runs) {
    write_file(file, text.data(), text.size());
    std::error_code ec;
    if (runs)
        fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                        fs::perm_options::add, ec);
}

}  // namespace

std::string slurm_script(const ScriptOptions& o) {
    const std::size_t chunk = (o.tasks + kMostInArray - 1) / kMostInArray, n = (o.tasks + chunk - 1) / chunk;
    return fmt::format(
        "#!/bin/sh\n"
        "# {} variants as an array job: sbatch slurm.sh, again for those that failed or were killed; then\n"
        "# tuft variants FOLDER --gather.\n"
        "#SBATCH --job-name=tuft-variants\n"
        "#SBATCH --array=0-{}\n"
        "#SBATCH --cpus-per-task=1\n"
        "#SBATCH --requeue\n"
        "#SBATCH --output=/dev/null\n"
        "exec {} run-task {} $((SLURM_ARRAY_TASK_ID * {})) --count {} --threads 1 --quiet\n",
        o.tasks, n - 1, quoted(o.program.string()), quoted(o.folder.string()), chunk, chunk);
}

std::string parallel_script(const ScriptOptions& o) {
    return fmt::format(
        "#!/bin/sh\n"
        "# {} variants by GNU parallel; its options may follow, such as --jobs 8 or --sshloginfile HOSTS. Then\n"
        "# tuft variants FOLDER --gather.\n"
        "seq 0 {} | exec parallel --will-cite \"$@\" {} run-task {} {{}} --threads 1 --quiet\n",
        o.tasks, o.tasks - 1, quoted(quoted(o.program.string())), quoted(quoted(o.folder.string())));
}

std::string openjd_template(const ScriptOptions& o) {
    return fmt::format(
        "# Not run on a render farm: none was at hand. The rules are those of the specification and of openjd-model.\n"
        "specificationVersion: jobtemplate-2023-09\n"
        "name: {}\n"
        "parameterDefinitions:\n"
        "  - name: Jobs\n"
        "    type: PATH\n"
        "    objectType: DIRECTORY\n"
        "    dataFlow: INOUT\n"
        "    default: .\n"  // this file's folder: an absolute default is refused
        "  - name: Tuft\n"
        "    type: STRING\n"
        "    default: tuft\n"
        "steps:\n"
        "  - name: Variants\n"
        "    parameterSpace:\n"
        "      taskParameterDefinitions:\n"
        "        - name: Index\n"
        "          type: INT\n"
        "          range: \"0-{}\"\n"
        "    script:\n"
        "      actions:\n"
        "        onRun:\n"
        "          command: \"{{{{Param.Tuft}}}}\"\n"
        "          args: [\"run-task\", \"{{{{Param.Jobs}}}}\", \"{{{{Task.Param.Index}}}}\", \"--threads\", \"1\"]\n"
        "  - name: Gather\n"
        "    dependencies:\n"
        "      - dependsOn: Variants\n"
        "    script:\n"
        "      actions:\n"
        "        onRun:\n"
        "          command: \"{{{{Param.Tuft}}}}\"\n"
        "          args: [\"variants\", \"{{{{Param.Jobs}}}}\", \"--gather\"]\n",
        yaml_text("tuft variants: " + o.name), o.tasks - 1);
}

void write_scripts(const ScriptOptions& o) {
    write_text(o.folder / "slurm.sh", slurm_script(o), true);
    write_text(o.folder / "parallel.sh", parallel_script(o), true);
    write_text(o.folder / "openjd.yaml", openjd_template(o), false);
}

}  // namespace tuft::variants
