/* Whether a seamless map can be unfolded before integers are chosen. Internal. */
#ifndef QC_MAP_ROOM_H
#define QC_MAP_ROOM_H

#include <qc/map.h>

/* FAILED (where = vertex) where qc_map_round would find that hard features leave no room, as
 * quickly as that is known; errors as there. */
qc_status qc__map_has_room(qc_ctx *ctx, const qc_seamless_map *seamless);

#endif
