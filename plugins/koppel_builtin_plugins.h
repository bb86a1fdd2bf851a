/* The standard plugins that are linked in. The build generates the table from its list of sources. */
#ifndef KOPPEL_BUILTIN_PLUGINS_H
#define KOPPEL_BUILTIN_PLUGINS_H

#include "koppel/plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct koppel_builtin_plugin {
  const char* type; /* the name of its one type */
  const koppel_plugin_entry* entry;
} koppel_builtin_plugin;

extern const koppel_builtin_plugin koppel_builtin_plugins[];
extern const size_t koppel_builtin_plugin_count;

#ifdef __cplusplus
}
#endif
#endif /* KOPPEL_BUILTIN_PLUGINS_H */
