// Where tests find what they read and leave what they write. Only folders.cpp knows the paths, so that the object code
// of no test depends on where the sources lie, and a compiler's cache serves every clone.
#pragma once

#include <string>

namespace koppel::test {

std::string scenes_folder();            ///< the shipped scenes
std::string tests_folder();             ///< the sources of the tests
std::string build_folder();             ///< the build's top folder
std::string standard_plugins_folder();  ///< shared objects that koppel ships
std::string test_plugins_folder();      ///< shared objects of good strangers; those of bad ones in bad/ below it

}  // namespace koppel::test
