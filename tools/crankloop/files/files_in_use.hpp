// No output of a command is a file that the command reads, and no two outputs are the same file.
//
// What belongs here: that rule, for all commands. What does not: how a file is read (text_file.hpp) or written
// (output_file.hpp); both ask here.
#pragma once

#include <string>

namespace crankloop::program {

/// From now on, for the one command of this process, files are the same when they are the same on the disk: by another
/// path, through a symbolic link, or as a hard link. Without this call the functions below allow everything.
///
/// Reading a file to which standard output or stderr goes throws InputError: `> FILE` has emptied it by then, and
/// `>> FILE` would append to it.
void watch_files_in_use();

/// Before an output is opened. `path` is that of a file, made or to be made, or "-" for standard output. Throws
/// InputError where the command has read the file, where another output has claimed it, or where standard output or
/// stderr goes there. What is no regular file, such as /dev/null, may be claimed at any time.
void claim_output(const std::string& path);

/// Once more before the output appears at `path`, for what was read after claim_output(). Throws InputError.
void demand_unread(const std::string& path);

}  // namespace crankloop::program
