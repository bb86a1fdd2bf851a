#include "batch.hpp"
#include "matrix_numbers.hpp"
#include "operations.hpp"

namespace koppel::bench {

Library koppel_library() {
  Library library;
  list_operations<double>(library);
  return library;
}

}  // namespace koppel::bench
