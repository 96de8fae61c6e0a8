/* numeric.c for real matrices. */
#define QC__REAL
#include "sdk/sparse/factor/numeric.c"
