// `crankloop pack DIR -o X.fmu`: a folder as an archive whose bytes do not depend on the machine.
#include "../command_line/commands.hpp"
#include "../files/error.hpp"
#include "../files/output_file.hpp"
#include "../files/stored_zip.hpp"

namespace crankloop::program {
namespace {

int run_pack(const Arguments& arguments) {
  std::vector<ZipEntry> entries = files_below(arguments.file());
  if (entries.empty()) throw InputError(arguments.file() + ": there is nothing in it");
  sort_as_fmu(entries);
  const std::string archive = stored_zip(entries);
  Output out(arguments.text("--output"));
  out.write(archive);
  out.finish();
  return kSuccess;
}

constexpr Option kPackOptions[] = {required(text("--output", "FILE.fmu", "the archive to write; -o for short"))};

}  // namespace

const Command kPack{"pack",
                    "the files of a folder as an FMU: a ZIP archive, the same bytes on any machine and day",
                    "FOLDER -o FILE.fmu",
                    "crankloop pack my_engine_fmu -o my_engine.fmu",
                    1,
                    kPackOptions,
                    run_pack,
                    true};

}  // namespace crankloop::program
