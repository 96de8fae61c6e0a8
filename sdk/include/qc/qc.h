/* qc/qc.h - the whole SDK in one include. */
#ifndef QC_QC_H
#define QC_QC_H

#include <qc/base.h>
#include <qc/closest_point.h>
#include <qc/cover.h>
#include <qc/dec.h>
#include <qc/field.h>
#include <qc/finish.h>
#include <qc/map.h>
#include <qc/mesh.h>
#include <qc/optimize.h>
#include <qc/pipeline.h>
#include <qc/plugin.h>
#include <qc/ray.h>
#include <qc/remesh.h>
#include <qc/shape.h>
#include <qc/solver.h>
#include <qc/sparse.h>
#include <qc/stage.h>
#include <qc/stages.h>

#endif
