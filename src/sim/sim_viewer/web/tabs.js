// The page's tabs, in their order: name and module, which has `title`, `mount` and `unmount`.

export const TABS = {
  scene: "./scene.js",
  rviz: "./rviz.js",
  cameras: "./images.js",
  drive: "./drive.js",
  graph: "./tools/graph.js",
  plot: "./tools/plot.js",
  console: "./tools/console.js",
  topics: "./tools/topics.js",
  services: "./tools/services.js",
  parameters: "./tools/parameters.js",
  bags: "./tools/bags.js",
  tf: "./tools/tf.js",
};
