/* The entry of the plugin "acme". */
#include "acme.h"

#include <string.h>

static const koppel_joint_type* const joints[] = {
    &acme_varying_screw, &acme_bare_screw, &acme_hinge,     &acme_revolute, &acme_prismatic, &acme_helical,
    &acme_cylindrical,   &acme_universal,  &acme_spherical, &acme_planar,   &acme_free,      &acme_weld};

static const void* type_table(const char* interface_id, size_t index) {
  if (strcmp(interface_id, KOPPEL_JOINT_INTERFACE) != 0 || index >= ACME_COUNT(joints)) return NULL;
  return joints[index];
}

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = {
    .struct_size = sizeof(koppel_plugin_entry),
    .abi = {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH},
    .name = "acme",
    .type_table = type_table,
};
