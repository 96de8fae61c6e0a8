/* updown.c for real matrices. */
#define QC__REAL
#include "sdk/sparse/updown.c"
