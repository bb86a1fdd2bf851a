/* What the sources of the plugin "acme" share: it is somebody else's, written in C against plugin.h alone. */
#ifndef ACME_H
#define ACME_H

#include "koppel/plugin.h"

#define ACME_COUNT(array) (sizeof(array) / sizeof((array)[0]))

extern const koppel_joint_type acme_varying_screw;
extern const koppel_joint_type acme_bare_screw;

/* Joints that move as the standard ones do. */
extern const koppel_joint_type acme_hinge;
extern const koppel_joint_type acme_revolute;
extern const koppel_joint_type acme_prismatic;
extern const koppel_joint_type acme_helical;
extern const koppel_joint_type acme_cylindrical;
extern const koppel_joint_type acme_universal;
extern const koppel_joint_type acme_spherical;
extern const koppel_joint_type acme_planar;
extern const koppel_joint_type acme_free;
extern const koppel_joint_type acme_weld;

#endif
