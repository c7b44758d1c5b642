#pragma once

#include <filesystem>
#include <string>

/// \file
/// A folder of tasks on schedulers that are there already: texts of job scripts. Each task is `tuft run-task FOLDER
/// INDEX`.
namespace tuft::variants {

/// What a job script names.
struct ScriptOptions {
    std::filesystem::path folder;   ///< of the tasks, absolute
    std::filesystem::path program;  ///< tuft
    std::string name;
    std::size_t tasks = 1;
};

/// An array job of Slurm, at most 1,000 array tasks (MaxArraySize is 1001 where nothing else is set): each runs
/// neighbouring variants.
std::string slurm_script(const ScriptOptions& options);

/// All tasks by GNU parallel on this machine, or with --sshloginfile on others.
std::string parallel_script(const ScriptOptions& options);

/// A job template of the Open Job Description 2023-09, for render farms. Its folder of tasks is the template's own:
/// openjd-model refuses absolute defaults.
std::string openjd_template(const ScriptOptions& options);

/// Writes slurm.sh, parallel.sh and openjd.yaml into the folder.
void write_scripts(const ScriptOptions& options);

}  // namespace tuft::variants
