/* numeric.c for real matrices. */
#define QC__REAL
#include "sdk/sparse/numeric.c"
