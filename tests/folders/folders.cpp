#include "folders.hpp"

namespace koppel::test {

std::string scenes_folder() { return KOPPEL_SOURCE_FOLDER "/apps/scenes"; }

std::string tests_folder() { return KOPPEL_SOURCE_FOLDER "/tests"; }

std::string build_folder() { return KOPPEL_BUILD_FOLDER; }

std::string standard_plugins_folder() { return KOPPEL_BUILD_FOLDER "/lib/plugins"; }

std::string test_plugins_folder() { return KOPPEL_BUILD_FOLDER "/lib/test_plugins"; }

}  // namespace koppel::test
