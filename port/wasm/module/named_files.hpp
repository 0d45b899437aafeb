// The files of a page: texts by name, in place of a disk.
//
// What belongs here: those, and read_file() of crankloop/files/text_file.hpp, which finds them. What does not: what is
// in them.
#pragma once

#include <string>

namespace crankloop::page {

void put_file(std::string name, std::string bytes);
void forget_files();

}  // namespace crankloop::page
