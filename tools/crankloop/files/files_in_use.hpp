// No output of a command is a file that the command reads, and no two outputs are the same file.
//
// What belongs here: that rule, for all commands. What does not: how a file is read (text_file.hpp) or written
// (output_file.hpp); both ask here.
#pragma once

#include <string>

namespace crankloop::program {

/// Enables the checks for this process's command. Two files are the same if they are the same on the disk: also by
/// another path, a symbolic link or a hard link. Without this call the functions below allow everything.
///
/// Reading a file to which standard output or stderr goes throws InputError: `> FILE` has emptied it by then, and
/// `>> FILE` would append to it.
void watch_files_in_use();

/// Whether `path` is "-", or another name of the pipe, socket or terminal that standard output is, such as /dev/stdout.
[[nodiscard]] bool is_standard_output(const std::string& path);

/// Before an output is opened. `path` is that of a file, made or to be made, or of standard output. Throws InputError
/// where the command has read the file, where another output has claimed it, or where standard output or stderr goes
/// there. A pipe or device is claimed by one output alone too; /dev/null may always be claimed.
void claim_output(const std::string& path);

/// Checks again before the output appears at `path`, against files read after claim_output(). Throws InputError.
void demand_unread(const std::string& path);

}  // namespace crankloop::program
