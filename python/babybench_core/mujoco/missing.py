"""Names of MuJoCo 3.3.0 that are not here, and what programs can do instead."""

from __future__ import annotations

_WINDOW = (
    "there is no OpenGL window: draw with mujoco.Renderer, whose scene takes markers, or show a page with mujoco.viewer"
)
_OPENGL = "there is no OpenGL: mujoco.Renderer draws pictures, depths and segmentations, and its scene takes markers"
_PLUGINS = "the engine has no plugins: use MuJoCo for models that need them"
_FLEXES = "flexes move in steps: read model.flex_vert, data.flexvert_xpos and the like"
_STAGES = (
    "the engine computes stages together: call mj_fwdPosition, mj_fwdVelocity, mj_fwdConstraint, mj_forward or mj_step"
)
_FILES = "compiled models are not written: keep the document, or pickle the model"
_PRINTED = "nothing prints whole models and states: print the arrays that you need"
_ARITHMETIC = "use NumPy"
_DEFAULTS = "make a model from a document: its options are then the default ones"
_PYTHON = "it is not part of MuJoCo's interface: import it from its own module"

_WHY: dict[str, str] = {
    _WINDOW: """mjv_applyPerturbForce mjv_applyPerturbPose mjv_initPerturb mjv_movePerturb mjv_moveCamera mjv_moveModel
        mjv_select mjv_cameraInModel mjv_cameraInRoom mjv_model2room mjv_room2model mjv_alignToCamera
        mjv_averageCamera mjv_frustumHeight mjv_updateCamera mjv_updateScene mjv_addGeoms mjv_makeLights
        mjv_updateSkin glfw""",
    _OPENGL: """mjr_addAux mjr_blitAux mjr_blitBuffer mjr_changeFont mjr_drawPixels mjr_figure mjr_findRect mjr_finish
        mjr_getError mjr_label mjr_maxViewport mjr_overlay mjr_readPixels mjr_rectangle mjr_render
        mjr_resizeOffscreen mjr_restoreBuffer mjr_setAux mjr_setBuffer mjr_text mjr_uploadHField mjr_uploadMesh
        mjr_uploadTexture GLContext gl_context""",
    _PLUGINS: "mj_loadAllPluginLibraries mj_loadPluginLibrary MjsPlugin PLUGINS_DIR PLUGIN_HANDLES HEADERS_DIR",
    _FLEXES: "mj_flex mju_rayFlex MjsFlex",
    _STAGES: """mj_Euler mj_RungeKutta mj_implicit mj_forwardSkip mj_inverseSkip mj_island mj_projectConstraint
        mj_referenceConstraint mj_constraintUpdate mj_sensorAcc mj_sensorPos mj_sensorVel""",
    _FILES: "mj_saveModel mj_sizeModel MjByteVec MjCharVec MjStringVec MjStruct MjsElement to_zip zipfile",
    _PRINTED: """mj_printData mj_printFormattedData mj_printFormattedModel mj_printModel mj_printSchema mju_printMatSparse
        mju_writeLog mj_resetDataDebug""",
    _ARITHMETIC: """mju_band2Dense mju_bandDiag mju_bandMulMatVec mju_boxQP mju_cholFactorBand mju_cholSolveBand mju_dense2Band
        mju_eig3 mju_mat2Rot mju_standardNormal mj_mulM2 mj_solveM2 mj_addM mju_encodePyramid mju_decodePyramid""",
    "contacts are found by the engine: use an equality constraint, or data.xfrc_applied": "mj_addContact",
    "mj_step refuses numbers that are not finite": "mj_checkAcc mj_checkPos mj_checkVel",
    _DEFAULTS: """mj_defaultOption mj_defaultSolRefImp mj_defaultVisual MjVisual MjVisualHeadlight MjVisualRgba MjStatistic""",
    "contacts are made by the engine: read data.contact": "MjContact",
    "data.xpos and data.xmat with NumPy do the same": "mj_local2Global mj_angmomMat",
    "sensors of a document (framelinacc, frameangacc) measure it": "mj_objectAcceleration",
    "mj_ray meets all geoms of the model": "mj_rayHfield mj_rayMesh mju_rayGeom mju_raySkin",
    "<lengthrange> of <compiler> in the document finds ranges of lengths": "mj_setLengthRange",
    "errors are RuntimeError, ValueError and NotImplementedError": "FatalError UnexpectedError",
    _PYTHON: "Any IO Sequence TypeAlias Union ctypes os platform renderer subprocess warnings",
}

WHY = {name: why for why, names in _WHY.items() for name in names.split()}
"""What to do instead, by MuJoCo's names."""


def hint(name: str) -> str:
    """Returns what to do instead of using a name."""
    if name in WHY:
        return f"{WHY[name]}; `pip install mujoco` and `import mujoco` have everything"
    return "MuJoCo 3.3.0 does not have it either"
