/* Reference counts of shared objects. */
#include <qc/base.h>

void qc_object_init(qc_object *object, const char *type, void (*destroy)(qc_object *)) {
    *object = (qc_object){type, destroy, 1, 0};
}

/* The count is a plain int32_t in the ABI (C++ has no _Atomic); the compiler's builtins make the
 * accesses atomic. */
void *qc_object_retain(const void *object) {
    qc_object *o = (qc_object *)(uintptr_t)object;
    if (o) __atomic_add_fetch(&o->references, 1, __ATOMIC_RELAXED);
    return o;
}

void qc_object_release(const void *object) {
    qc_object *o = (qc_object *)(uintptr_t)object;
    if (o && __atomic_sub_fetch(&o->references, 1, __ATOMIC_ACQ_REL) == 0) o->destroy(o);
}
