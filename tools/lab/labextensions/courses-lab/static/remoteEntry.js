// Tiles of the launcher, and buttons above the editor. Written by hand as the module container that JupyterLab
// loads: it needs no build. What an act does is in courses_lab.py; here its terminal is shown.
(() => {
  let shared = null;

  /** A module of JupyterLab's own. */
  async function its(name) {
    const [version] = Object.keys(shared[name]);
    return (await shared[name][version].get())();
  }

  const PLAY = "M4 2 L14 8 L4 14 Z";
  const FLAG = "M3 1 V15 M3 2 H13 L10 5 L13 8 H3";
  const BACK = "M8 3 A5 5 0 1 1 3 8 M8 0 L4 3 L8 6";
  const PAGE = "M3 1 H13 V15 H3 Z M5 5 H11 M5 8 H11 M5 11 H9";
  const TICK = "M2 9 L6 13 L14 3";
  const WORLD = "M1 14 L6 2 H10 L15 14 M8 3 V6 M8 8 V11";

  async function plugins() {
    const [{ ILauncher }, { ICommandPalette, InputDialog, Notification, ToolbarButton }, { LabIcon },
      { ServerConnection }, { URLExt }] = await Promise.all([
      its("@jupyterlab/launcher"), its("@jupyterlab/apputils"), its("@jupyterlab/ui-components"),
      its("@jupyterlab/services"), its("@jupyterlab/coreutils")]);
    const icon = (name, path) => new LabIcon({
      name: `courses-lab:${name}`,
      svgstr: `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 16" width="16"><path d="${path}"`
        + ' fill="none" stroke="#616161" stroke-width="1.6" stroke-linejoin="round"/></svg>',
    });

    async function ask(place, body) {
      const settings = ServerConnection.makeSettings();
      const answer = await ServerConnection.makeRequest(
        URLExt.join(settings.baseUrl, "courses", place),
        body ? { method: "POST", body: JSON.stringify(body) } : {}, settings);
      const data = await answer.json();
      if (!answer.ok) throw new Error(data.message ?? answer.statusText);
      return data;
    }

    async function activate(app, launcher, palette) {
      const { commands, shell } = app;
      const menu = await ask("menu");
      const { texts } = menu;
      const ours = [texts.courses, texts.lessons].map((one) => `:has([data-category="${one}"])`);
      window.document.head.append(Object.assign(window.document.createElement("style"), {
        textContent: ".jp-Launcher-content { display: flex; flex-direction: column; }"
          + `.jp-Launcher-section:is(${ours}) { order: -1; }`, // our tiles before JupyterLab's
      }));
      const tell = (error) => Notification.error(error.message, { autoClose: false });

      const terminals = () => [...shell.widgets("main")].filter((one) => one.node.querySelector(".jp-Terminal"));

      /** Show a terminal, a new one among the others. */
      async function show(name) {
        const others = terminals();
        const shown = await commands.execute("terminal:open", { name });
        if (others.length && !others.includes(shown)) {
          shell.add(shown, "main", { ref: others[0].id, mode: "tab-after" });
        }
        shell.activateById(shown.id);
      }

      async function act(name, what) {
        try {
          const done = await ask("do", { act: name, what });
          if (done.terminal) await show(done.terminal);
          return done;
        } catch (error) {
          tell(error);
          return null;
        }
      }

      const document = () => shell.currentWidget?.context ?? null;
      const save = async (context) => {
        if (context.model.dirty) await context.save();
      };
      const opened = (path, factory) => commands.execute("docmanager:open", { path, factory });

      async function choose(title, items) {
        const chosen = await InputDialog.getItem({ title, items: items.map((one) => one.label) });
        return chosen.button.accept ? items.find((one) => one.label === chosen.value) : null;
      }

      async function openLesson(lesson) {
        await opened(lesson.page, "Markdown Preview");
        await opened(lesson.script, "Editor");
      }

      async function ofFile(name, context) {
        try {
          await save(context);
        } catch (error) {
          tell(error);
          return;
        }
        const { path } = context;
        if (name === "world") {
          const lesson = menu.lessons.find((one) => one.script === path);
          if (lesson) await act("course", lesson.course);
          else Notification.info(texts.no_world);
          return;
        }
        const done = await act(name, path);
        if (done?.kept) {
          await context.revert();
          Notification.info(`${texts.kept} ${done.kept}`);
        }
      }

      async function marks() {
        const contents = app.serviceManager.contents;
        try {
          await contents.get(`${menu.marks}/report.json`, { content: false });
        } catch {
          Notification.info(texts.no_marks);
          return;
        }
        await opened(`${menu.marks}/report.json`);
        await opened(`${menu.marks}/path.png`);
      }

      function add(id, label, drawn, execute, category, rank) {
        commands.addCommand(id, { label, icon: drawn, execute });
        palette?.addItem({ command: id, category: texts.lessons });
        if (category) launcher?.add({ command: id, category, rank });
      }
      menu.courses.forEach(({ name, label }, rank) => add(`courses:start-${name}`, label,
        icon(`start-${name}`, WORLD), () => act("course", name), texts.courses, rank));
      add("courses:open", texts.open, icon("open", PAGE), async () => {
        const lesson = await choose(texts.open, menu.lessons);
        if (lesson) await openLesson(lesson);
      }, texts.lessons, 1);
      add("courses:check", texts.check, icon("check", TICK), async () => {
        const exercise = await choose(texts.check, menu.exercises);
        if (!exercise) return;
        await opened(exercise.script, "Editor");
        await act("check", exercise.name);
      }, texts.lessons, 2);
      add("courses:marks", texts.marks, icon("marks", FLAG), marks, texts.lessons, 3);

      const buttons = { run: PLAY, world: WORLD, lap: FLAG, reset: BACK };
      const icons = Object.fromEntries(Object.entries(buttons).map(([name, path]) => [name, icon(name, path)]));
      Object.keys(buttons).forEach((name) => add(`courses:${name}`, texts[name], icons[name], async () => {
        if (document()) await ofFile(name, document());
      }));
      commands.addKeyBinding({ command: "courses:run", keys: ["F5"], selector: ".jp-FileEditor" });
      app.docRegistry.addWidgetExtension("Editor", {
        createNew(widget, context) {
          Object.keys(buttons).reverse().forEach((name) => widget.toolbar.insertItem(0, `courses-${name}`,
            new ToolbarButton({
              icon: icons[name], label: texts[name], tooltip: name === "run" ? `${texts.run} (F5)` : texts[name],
              onClick: () => ofFile(name, context),
            })));
        },
      });

      // The tiles, behind the lesson's page; where no page is open, JupyterLab shows them by itself.
      app.restored.then(() => {
        const shown = [...shell.widgets("main")];
        const page = shown.find((one) => one.node.querySelector(".jp-MarkdownViewer"));
        const has = shown.some((one) => one.node.querySelector(".jp-Launcher"));
        if (window.matchMedia("(max-width: 760px)").matches) shell.mode = "single-document"; // a phone
        if (launcher && page && !has) commands.execute("launcher:create", { ref: page.id, activate: false });
      });
    }

    return { __esModule: true, default: [{ id: "courses-lab:plugin", autoStart: true, optional: [ILauncher, ICommandPalette], activate }] };
  }

  window._JUPYTERLAB ??= {};
  window._JUPYTERLAB["courses-lab"] = {
    init: (scope) => { shared = scope; },
    get: async () => {
      const module = await plugins();
      return () => module;
    },
  };
})();
