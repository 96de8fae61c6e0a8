/* front.c for real matrices. */
#define QC__REAL
#include "sdk/sparse/factor/front.c"
