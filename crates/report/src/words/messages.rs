//! Every text of the report in every language, one line each. Words in braces stand for values.

/// A text in every language.
pub(super) struct Message {
    pub(super) key: &'static str,
    pub(super) english: &'static str,
    pub(super) chinese: &'static str,
}

macro_rules! messages {
    ($($key:literal: $english:literal | $chinese:literal;)*) => {
        /// The table.
        pub(super) const MESSAGES: &[Message] = &[$(Message {
            key: $key,
            english: $english,
            chinese: $chinese,
        }),*];
    };
}

messages! {
    "page.title": "Report of the computed results" | "计算结果报告";
    "page.footer": "Catenix: report of the computed results" | "Catenix 计算结果报告";
    "page.contents": "Contents" | "目录";
    "page.figure": "Figure" | "图";
    "page.table": "Table" | "表";
    "page.after_number": "." | "";
    "page.full_stop": "." | "。";
    "page.at": "at" | "位于";
    "page.cases": "load cases:" | "工况数：";

    "list.separator": ", " | "、";

    "channel.separator": ", " | "，";
    "channel.at": "{quantity} at {place}" | "{place} 处的{quantity}";

    "end.a": "end A" | "A 端";
    "end.b": "end B" | "B 端";

    "section.system": "The system" | "系统组成";
    "section.environment": "The sea" | "海洋环境";
    "section.results": "Load cases and key results" | "工况与主要结果";
    "section.shapes": "Shapes and trajectories" | "形态与轨迹";
    "section.histories": "Time histories" | "时间历程";
    "section.ranges": "Along the lines" | "沿管线的分布";
    "section.modes": "Natural modes" | "固有模态";
    "section.accuracy": "Accuracy" | "精度";
    "section.solver": "The solver's account" | "求解统计";
    "section.provenance": "Where the results come from" | "结果来源";

    "status.pending": "not begun" | "未开始";
    "status.running": "running" | "计算中";
    "status.complete": "complete" | "已完成";
    "status.interrupted": "interrupted" | "已中断";
    "status.failed": "failed" | "失败";

    "notice.interrupted": "The run was interrupted. What follows is what had been computed until then." | "计算被中断。以下为中断之前已算得的结果。";
    "notice.failed": "The solver gave up in at least one load case. What follows is what had been computed until then." | "至少有一个工况求解失败。以下为失败之前已算得的结果。";
    "notice.running": "The run has not ended: it goes on, or its process was killed. What follows is what had been stored when this report was made." | "计算尚未结束：仍在进行，或其进程已被终止。以下为生成本报告时已存储的结果。";
    "notice.case": "Load case {case}: {status}, results up to {time}." | "工况 {case}：{status}，结果截至 {time}。";
    "notice.case_without": "Load case {case}: {status}, no results." | "工况 {case}：{status}，无结果。";
    "notice.error": "The solver's message: {message}" | "求解器信息：{message}";

    "axis.time": "Time" | "时间";
    "axis.arc_length": "Distance from end A" | "距 A 端的弧长";
    "axis.x": "x" | "x";
    "axis.y": "y" | "y";
    "axis.z": "z" | "z";

    "quantity.x": "x" | "x 坐标";
    "quantity.y": "y" | "y 坐标";
    "quantity.z": "z" | "z 坐标";
    "quantity.offset_x": "offset x" | "x 向偏移";
    "quantity.offset_y": "offset y" | "y 向偏移";
    "quantity.offset_z": "offset z" | "z 向偏移";
    "quantity.tilt": "tilt" | "倾角";
    "quantity.roll": "roll" | "横摇角";
    "quantity.pitch": "pitch" | "纵摇角";
    "quantity.heading": "heading" | "艏向角";
    "quantity.force_x": "force x" | "x 向力";
    "quantity.force_y": "force y" | "y 向力";
    "quantity.force_z": "force z" | "z 向力";
    "quantity.moment_x": "moment x" | "x 向力矩";
    "quantity.moment_y": "moment y" | "y 向力矩";
    "quantity.moment_z": "moment z" | "z 向力矩";
    "quantity.effective_tension": "effective tension" | "有效张力";
    "quantity.wall_tension": "wall tension" | "管壁张力";
    "quantity.shear_force": "shear force" | "剪力";
    "quantity.bend_moment": "bending moment" | "弯矩";
    "quantity.curvature": "curvature" | "曲率";
    "quantity.torque": "torque" | "扭矩";
    "quantity.von_mises_stress": "von Mises stress" | "冯·米塞斯应力";
    "quantity.declination": "declination" | "偏角";

    "drawing.title": "The system at rest, to scale" | "系统静态形态（按比例绘制）";
    "drawing.caption": "Side view, {axis} to the right and z up. Lines and their lengths are to scale; vessels, anchors, floats and weights are signs." | "侧视图，{axis} 轴向右，z 轴向上。管线及其长度按比例绘制；船舶、锚点、浮体和配重为示意符号。";
    "drawing.of_case": "Load case {case}." | "工况 {case}。";
    "drawing.surface": "sea surface" | "海面";
    "drawing.seabed": "seabed" | "海床";
    "drawing.depth": "depth {depth}" | "水深 {depth}";
    "drawing.vessel": "{name}" | "{name}";
    "drawing.anchor": "{name} (fixed)" | "{name}（固定）";
    "drawing.body": "{name}, {mass}" | "{name}，{mass}";
    "drawing.line": "{name}, {length}" | "{name}，{length}";
    "drawing.float": "{name}: lift {weight}, at {place}" | "{name}：净浮力 {weight}，位于 {place}";
    "drawing.weight": "{name}: weight {weight}, at {place}" | "{name}：水中重量 {weight}，位于 {place}";

    "system.no_scene": "The store was written by an earlier version of Catenix, which did not keep a description of the system." | "该结果库由较早版本的 Catenix 写成，其中没有系统描述。";
    "system.lines": "Lines" | "管线";
    "system.line": "Line" | "管线";
    "system.length": "Length" | "长度";
    "system.elements": "Elements" | "单元数";
    "system.sections": "Sections, from end A" | "管段（自 A 端起）";
    "system.section": "{type}: {length}, outer diameter {diameter}" | "{type}：{length}，外径 {diameter}";
    "system.more": "and {count} more" | "另有 {count} 段";
    "system.end_a": "End A" | "A 端";
    "system.end_b": "End B" | "B 端";
    "system.free": "free" | "自由";
    "system.held": "{support} ({joint})" | "{support}（{joint}）";

    "joint.ball": "ball joint" | "球铰";
    "joint.flex_joint": "flex joint" | "柔性接头";
    "joint.universal": "universal joint" | "万向铰";
    "joint.hinge": "hinge" | "铰链";
    "joint.fixed": "fixed" | "固接";

    "system.bodies": "Bodies" | "刚体";
    "system.body": "Body" | "刚体";
    "system.mass": "Mass" | "质量";
    "system.volume": "Volume" | "排水体积";
    "system.offset_vessel": "Offset against" | "偏移参照";
    "system.vessels": "Vessels and anchors" | "船舶与锚点";
    "system.vessels_note": "Positions are those at rest." | "位置为静止时的位置。";
    "system.vessel": "Name" | "名称";
    "system.heading": "Heading" | "艏向角";
    "system.motion": "Motion" | "运动";
    "system.moves": "prescribed" | "给定运动";
    "system.stays": "none" | "不动";
    "system.attachments": "Floats, weights and pumps on lines" | "管线上的浮体、配重和泵";
    "system.attachments_note": "Weight in water; negative for a float." | "水中重量；浮体为负值。";
    "system.attachment": "Name" | "名称";
    "system.wet_weight": "Weight in water" | "水中重量";

    "environment.no_water": "There is no water." | "无水环境。";
    "environment.water": "Water depth {depth}; lines may pass through the seabed." | "水深 {depth}；未考虑海床接触。";
    "environment.water_and_seabed": "Water depth {depth}; lines and bodies rest on the seabed where they meet it." | "水深 {depth}；管线和刚体与海床接触时由海床支承。";
    "environment.still": "The water is still." | "静水，无海流。";
    "environment.speed": "Current speed" | "海流流速";
    "environment.heading": "Heading of the current" | "海流流向";
    "environment.over_depth": "{what} over depth" | "{what}随深度的分布";
    "environment.cases": "cases {cases}" | "工况 {cases}";
    "environment.flows_to": "The current flows towards {heading}, from the x axis towards y." | "海流流向为 {heading}（自 x 轴转向 y 轴）。";
    "environment.flows_to_in": "In case {cases} the current flows towards {heading}, from the x axis towards y." | "工况 {cases} 的海流流向为 {heading}（自 x 轴转向 y 轴）。";
    "environment.factor": "The current varies over time: the profile is multiplied by a factor of the model file." | "海流随时间变化：剖面乘以模型文件给定的系数。";

    "results.cases": "Load cases" | "工况";
    "results.case": "Case" | "工况";
    "results.description": "Description" | "说明";
    "results.status": "Status" | "状态";
    "results.simulated": "Simulated" | "模拟时长";
    "results.window": "Statistics window" | "统计时段";
    "results.from_to": "{from} to {to}" | "{from} 至 {to}";
    "results.key": "Key results" | "主要结果";
    "results.caption": "Means are over the statistics window; smallest and largest values are over the whole run, t = 0 included." | "平均值取自统计时段；最小值和最大值取自整个计算过程（含 t = 0）。";
    "results.result": "Result" | "结果";
    "results.unit": "Unit" | "单位";
    "results.body": "{body}" | "{body}";
    "results.body_from": "{body}, against {vessel}" | "{body}，相对于 {vessel}";
    "results.end": "{line}, {end}: force on what it is connected to" | "{line} {end}：对所连物体的作用力";
    "results.along": "{line}, along the whole line" | "{line}，全线";
    "results.mean": "{quantity}, mean" | "{quantity}，平均值";
    "results.smallest": "{quantity}, smallest" | "{quantity}，最小值";
    "results.largest": "{quantity}, largest" | "{quantity}，最大值";
    "results.references": "Results from elsewhere beside the computed ones" | "计算结果与其他来源结果的对比";
    "results.references_note": "The difference is computed less reference, or less the nearer end of a range." | "差值为计算值减去参考值；参考值为范围时，取至较近的端点。";
    "results.elsewhere": "Reference" | "参考值";
    "results.computed": "Computed" | "计算值";
    "results.difference": "Difference" | "差值";
    "results.inside": "inside" | "在范围内";

    "shapes.at_rest": "Static shape" | "静态形态";
    "shapes.at_end": "Shape at the end of the motion" | "运动结束时的形态";
    "shapes.rest": "at rest" | "静态";
    "shapes.end": "after {time}" | "{time} 后";
    "shapes.time": "After {time}." | "{time} 后。";
    "shapes.each_end": "Each case at its own end." | "各工况取其结束时刻。";
    "shapes.seen": "{what}, {view}" | "{what}，{view}";
    "shapes.side": "side view along y" | "沿 y 轴的侧视图";
    "shapes.front": "view along x" | "沿 x 轴的视图";
    "shapes.plan": "from above" | "俯视图";
    "shapes.to_scale": "To scale." | "按比例绘制。";
    "shapes.way": "Trajectory of {body}" | "{body}的轨迹";
    "shapes.way_from": "Trajectory of {body} against {vessel}" | "{body}相对于{vessel}的轨迹";
    "shapes.way_note": "The axes have different scales." | "各坐标轴比例不同。";

    "histories.offset": "Offset of {body} from {vessel}, and its tilt" | "{body}相对于{vessel}的偏移及其倾角";
    "histories.position": "Position of {body}, and its tilt" | "{body}的位置及其倾角";
    "histories.tension": "Effective tension at the ends of {line}" | "{line}两端的有效张力";
    "histories.force": "Force of {line} on {support}" | "{line}对{support}的作用力";
    "histories.points": "Points along lines" | "管线上各点";
    "histories.motion": "Prescribed motion of {vessel}" | "{vessel}的给定运动";

    "ranges.title": "{line}: {quantity} along the line" | "{line}：{quantity}沿管线的分布";
    "ranges.caption": "Means are over the statistics window, smallest and largest values over the whole run." | "平均值取自统计时段，最小值和最大值取自整个计算过程。";
    "ranges.unfinished": "The case has not ended: all values are over the last stored stretch." | "工况尚未结束：各值取自最后存储的时段。";
    "ranges.window": "range in the statistics window" | "统计时段内的范围";
    "ranges.mean": "mean over the statistics window" | "统计时段平均值";
    "ranges.largest": "largest of the run" | "全程最大值";
    "ranges.smallest": "smallest of the run" | "全程最小值";
    "ranges.largest_of": "{quantity}, largest" | "{quantity}最大值";
    "ranges.mean_of": "{quantity}, mean" | "{quantity}平均值";
    "ranges.smallest_of": "{quantity}, smallest" | "{quantity}最小值";

    "modes.title": "Natural modes, case {case}" | "固有模态，工况 {case}";
    "modes.number": "Mode" | "阶次";
    "modes.frequency": "Frequency [Hz]" | "频率 [Hz]";
    "modes.period": "Period [s]" | "周期 [s]";
    "modes.damping": "Damping [%]" | "阻尼比 [%]";
    "modes.moves_most": "Moves most" | "最大位移处";
    "modes.motion": "Motion, share of the energy" | "运动形式（能量占比）";
    "modes.mass": "Effective mass x / y / z [%]" | "有效质量 x / y / z [%]";
    "modes.in_water": "About the static equilibrium, undamped, with the added mass of the water." | "相对于静平衡位置，无阻尼，计入水的附加质量。";
    "modes.in_air": "About the static equilibrium, undamped, without added mass." | "相对于静平衡位置，无阻尼，不计附加质量。";
    "modes.proof": "{count} modes were counted up to {frequency} Hz, and all were found." | "在 {frequency} Hz 以内共计 {count} 阶模态，全部求得。";
    "modes.unstable": "grows" | "发散";
    "modes.free": "free" | "自由";
    "modes.at": "{line} at {place}" | "{line} {place} 处";

    "motion.x": "x" | "x 向";
    "motion.y": "y" | "y 向";
    "motion.z": "z" | "z 向";
    "motion.axial": "axial" | "轴向";
    "motion.torsion": "torsion" | "扭转";
    "motion.rotation": "rotation" | "转动";

    "modes.of_line": "Mode shapes of {line}, case {case}" | "{line}的振型，工况 {case}";
    "modes.curve": "mode {number}, {frequency}, {axis}" | "第 {number} 阶，{frequency}，{axis} 向";
    "modes.displacement": "Displacement over the largest of the mode" | "位移与该阶最大位移之比";
    "modes.figure_note": "The largest component of the displacement; modes of equal frequency are drawn once." | "取位移的最大分量；频率相同的模态只绘制一次。";

    "accuracy.none": "The discretisation error of these results was not estimated: element lengths and time step are those of the model file." | "未估计这些结果的离散误差：单元长度和时间步长取自模型文件。";
    "accuracy.how": "To have element lengths and step chosen for an accuracy, and the remaining error of every headline result stated:" | "如需按给定精度选取单元长度和时间步长，并给出各主要结果的剩余误差，请运行：";
    "accuracy.about": "Element lengths and time step were chosen for the accuracy that was asked for. The errors that are left are estimates, of mesh and step apart." | "单元长度和时间步长按要求的精度选取。所列剩余误差为估计值，网格误差与步长误差分列。";
    "accuracy.title": "Estimated errors, case {case}" | "误差估计，工况 {case}";
    "accuracy.value": "Value" | "数值";
    "accuracy.mesh": "Error of the mesh" | "网格误差";
    "accuracy.step": "Error of the step" | "步长误差";
    "accuracy.relative": "Relative" | "相对误差";
    "accuracy.verdict": "Target" | "目标";
    "accuracy.met": "met" | "达到";
    "accuracy.missed": "missed" | "未达到";
    "accuracy.reported": "only reported" | "仅列出";
    "accuracy.reached": "The target of {target} was reached with {elements} elements and steps up to {step}, after {trials} trials." | "采用 {elements} 个单元、最大步长 {step}，经 {trials} 次试算达到 {target} 的目标。";
    "accuracy.not_reached": "The target of {target} was not reached with {elements} elements and steps up to {step}, after {trials} trials." | "采用 {elements} 个单元、最大步长 {step}，经 {trials} 次试算仍未达到 {target} 的目标。";

    "solver.title": "The solver's account" | "求解统计";
    "solver.caption": "The real-time factor is simulated time over processor time. The energy imbalance is energy that the account does not explain, as a share of the energy moved." | "实时倍率为模拟时长与处理器时间之比。能量不平衡为账目未能解释的能量占转移能量的比例。";
    "solver.static_iterations": "Iterations of the static solution" | "静力求解迭代次数";
    "solver.static_residual": "Residual of the static solution" | "静力求解残差";
    "solver.steps": "Time steps" | "时间步数";
    "solver.rejected": "Rejected steps" | "舍弃步数";
    "solver.iterations": "Newton iterations" | "牛顿迭代次数";
    "solver.per_step": "Iterations per step" | "每步迭代次数";
    "solver.factorisations": "Factorisations" | "矩阵分解次数";
    "solver.order": "Mean order of the integrator" | "积分器平均阶数";
    "solver.residual": "Largest residual of a step" | "单步最大残差";
    "solver.imbalance": "Energy imbalance" | "能量不平衡";
    "solver.cpu": "Processor time" | "处理器时间";
    "solver.wall": "Elapsed time" | "耗时";
    "solver.real_time": "Real-time factor" | "实时倍率";
    "solver.energies": "Energy account at the end" | "结束时的能量账目";
    "solver.warning": "Load case {case}: {warning}" | "工况 {case}：{warning}";

    "provenance.title": "Program, model and store" | "程序、模型与结果库";
    "provenance.what": "Item" | "项目";
    "provenance.value": "Value" | "内容";
    "provenance.version": "Computed by" | "计算程序";
    "provenance.created": "Store made on" | "结果库创建时间";
    "provenance.no_date": "not recorded" | "未记录";
    "provenance.model_file": "Model file" | "模型文件";
    "provenance.sha256": "SHA-256 of the model file" | "模型文件 SHA-256";
    "provenance.store": "Result store" | "结果库";
    "provenance.settings": "Settings" | "计算设置";
    "provenance.setting": "Setting" | "设置";

    "setting.duration": "Duration" | "持续时间";
    "setting.statistics_window": "Statistics window" | "统计时段";
    "setting.integrator": "Integrator" | "积分器";
    "setting.spectral_radius": "Spectral radius" | "谱半径";
    "setting.max_order": "Highest order" | "最高阶数";
    "setting.step": "Time step" | "时间步长";
    "setting.step_accuracy": "Error allowed per step" | "每步容许误差";
    "setting.step_min": "Shortest step" | "最小步长";
    "setting.step_max": "Longest step" | "最大步长";
    "setting.dynamics_tolerance": "Tolerance of a step" | "动力求解容差";
    "setting.dynamics_max_iterations": "Most iterations of a step" | "每步最大迭代次数";
    "setting.statics_tolerance": "Tolerance of the static solution" | "静力求解容差";
    "setting.statics_max_iterations": "Most iterations of the static solution" | "静力求解最大迭代次数";
    "setting.output_interval": "Output interval of histories" | "时间历程输出间隔";
    "setting.field_interval": "Output interval along lines" | "沿管线输出间隔";
    "setting.water_depth": "Water depth" | "水深";

    "word.bdf": "BDF" | "BDF";
    "word.generalised-alpha": "generalised-alpha" | "广义 α 法";

    "energy.kinetic": "kinetic energy" | "动能";
    "energy.elastic": "elastic energy" | "弹性能";
    "energy.potential": "potential energy of weight" | "重力势能";
    "energy.stored_change": "change of the stored energy" | "储存能量的变化";
    "energy.work_drag": "work of drag" | "阻力所做的功";
    "energy.work_added_mass": "work of added mass" | "附加质量所做的功";
    "energy.work_buoyancy": "work of buoyancy" | "浮力所做的功";
    "energy.work_seabed": "work of the seabed" | "海床所做的功";
    "energy.work_structural_damping": "work of structural damping" | "结构阻尼所做的功";
    "energy.work_moved_ends": "work of moved ends" | "运动端所做的功";
    "energy.work_loads": "work of loads" | "外载荷所做的功";
}
